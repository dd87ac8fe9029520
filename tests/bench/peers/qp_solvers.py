# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Solvers of quadratic programs by name, their times over a run, and the distance of two."""

import time
from collections.abc import Callable, Mapping, Sequence

import numpy as np
from bench.peers.qp_peers import Solve, bare_daqp, bare_osqp, cvxpy_osqp
from bench.peers.qp_programs import LIMIT, Step
from bench.skeleton.comparison import extra

from ddct_controllers.mpc.qp.backend import make_backend
from ddct_controllers.mpc.qp.problem import QpStructure


def backend(name: str) -> Callable[[QpStructure], Solve]:
    """Return a function that makes our backend called `name` for a structure."""

    def make(structure: QpStructure) -> Solve:
        made = make_backend(name, structure, LIMIT)
        return lambda f, lower, upper: made.solve(f, lower, upper).z

    return make


REFERENCES: Mapping[str, Callable[[QpStructure], Solve]] = {
    'DAQP bare': bare_daqp,
    'our backend for OSQP': backend('osqp'),
    'OSQP bare': bare_osqp,
    'cvxpy': lambda structure: cvxpy_osqp(extra('cvxpy'), structure),
}


def percentiles(times: Sequence[float]) -> dict[str, float]:
    """Return the median and the 99th percentile of times, by quantity."""
    median, p99 = np.percentile(times, [50, 99])
    return {'median': float(median), 'p99': float(p99)}


def solve_times(solve: Solve, steps: Sequence[Step]) -> dict[str, float]:
    """Return median and p99 in s of the solves of a run, each from the last solution."""
    times = []
    for step in steps:
        started = time.perf_counter()
        solve(*step)
        times.append(time.perf_counter() - started)
    return percentiles(times)


def distance(structure: QpStructure, solve: Solve, other: Solve, steps: Sequence[Step]) -> float:
    """
    Return the largest distance of two solvers' solutions over the largest solution.

    Both are in the norm of the Hessian.
    """
    found, expected = (np.array([each(*step) for step in steps]) for each in (solve, other))
    norms = [
        np.sqrt(np.einsum('ki,ij,kj->k', v, structure.hessian, v))
        for v in (found - expected, expected)
    ]
    return float(norms[0].max() / norms[1].max())
