# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time of quadratic programs of slip control with both backends, bare OSQP and cvxpy."""

import time
from typing import Any

import numpy as np
from qp_peers import Solve, bare_osqp, cvxpy_osqp_and_clarabel
from qp_programs import LIMIT, SlipControl

from ddct_controllers.mpc.qp.backend import BACKENDS, DEFAULT_BACKEND, make_backend
from ddct_controllers.mpc.qp.problem import QpStructure

SIZES = {
    '4 moves, 8 hard rows': (4, 22, False),
    '4 moves, 8 hard and 22 soft rows': (4, 22, True),
    '50 moves, 100 hard and 50 soft rows': (50, 50, True),
}
"""Number of moves, number of predicted outputs, and whether these have soft rows, by label."""
LARGEST = '50 moves, 100 hard and 50 soft rows'
P99_GOAL_US = 1000.0
_ROUNDS = 3
_COMPARED = 10
"""Number of steps from one comparison with Clarabel's solution to the next."""


def measure() -> dict[str, Any]:
    """
    Return for each size and solver the times per solve, their ratios to ours, and the error.

    The solvers solve the programs of a run in turn, in several rounds; each program starts from
    the solution of the one before. The error is the largest distance from Clarabel's solution
    over the largest solution, both in the norm of the hessian. Without cvxpy there is no error,
    and `skipped` is the reason.
    """
    return {label: _measure_size(SlipControl(*size)) for label, size in SIZES.items()}


def print_table(results: dict[str, Any]) -> None:
    """Print the results of `measure`."""
    p99_us = results[LARGEST]['solvers'][DEFAULT_BACKEND]['p99_us']
    verdict = 'met' if p99_us <= P99_GOAL_US else 'MISSED'
    print(f'QP of 50 steps with soft outputs, p99 at most {P99_GOAL_US:g} us: {verdict}')
    for label, found in results.items():
        print(f'QP, {label} (against {DEFAULT_BACKEND}):')
        for name, row in found['solvers'].items():
            error = f', error {row["error"]:.0e}' if 'error' in row else ''
            print(
                f'  {name:10} median {row["median_us"]:7.1f} us ({row["median_ratio"]:5.1f}x), '
                f'p99 {row["p99_us"]:7.1f} us ({row["p99_ratio"]:5.1f}x){error}'
            )
        if 'skipped' in found:
            print(f'  not compared: {found["skipped"]}')


def _measure_size(control: SlipControl) -> dict[str, Any]:
    structure = control.structure
    solvers = {name: _backend(name, structure) for name in BACKENDS}
    solvers['bare osqp'] = bare_osqp(structure)
    try:
        import cvxpy
    except ImportError as error:
        skipped = {'skipped': f'cvxpy is not installed ({error})'}
        return {'solvers': _run(control, solvers, None)} | skipped
    solvers['cvxpy'], exact = cvxpy_osqp_and_clarabel(cvxpy, structure)
    return {'solvers': _run(control, solvers, exact)}


def _backend(name: str, structure: QpStructure) -> Solve:
    backend = make_backend(name, structure, LIMIT)
    return lambda f, lower, upper: backend.solve(f, lower, upper).z


def _run(control: SlipControl, solvers: dict[str, Solve], exact: Solve | None) -> dict[str, Any]:
    steps = control.steps()
    references = [exact(*step) for step in steps[::_COMPARED]] if exact else []
    times: dict[str, list[float]] = {name: [] for name in solvers}
    solutions: dict[str, list[np.ndarray]] = {}
    for _ in range(_ROUNDS):
        for name, solve in solvers.items():
            solutions[name] = []
            for step in steps:
                started = time.perf_counter()
                z = solve(*step)
                times[name].append(1e6 * (time.perf_counter() - started))
                solutions[name].append(z)
    ours = np.percentile(times[DEFAULT_BACKEND], [50, 99])
    return {
        name: compared(np.percentile(taken, [50, 99]), ours)
        | _error(control.structure.hessian, solutions[name][::_COMPARED], references)
        for name, taken in times.items()
    }


def compared(times_us: np.ndarray, ours_us: np.ndarray) -> dict[str, float]:
    """Return median and p99 in us and their ratios to ours, by key; both arguments are (2,)."""
    ratios = times_us / ours_us
    return {
        'median_us': float(times_us[0]),
        'p99_us': float(times_us[1]),
        'median_ratio': float(ratios[0]),
        'p99_ratio': float(ratios[1]),
    }


def _error(
    hessian: np.ndarray, solutions: list[np.ndarray], references: list[np.ndarray]
) -> dict[str, float]:
    if not references:
        return {}
    exact = np.array(references)
    off = np.array(solutions) - exact
    distance, size = (np.sqrt(np.einsum('ki,ij,kj->k', v, hessian, v)) for v in (off, exact))
    return {'error': float(distance.max() / size.max())}
