# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time of one step of `mpc_preview`, that is filter, program and command, against peers."""

import warnings
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from qp import compared
from qp_peers import bare_osqp, cvxpy_osqp_and_clarabel
from replay import measurements_of, times_of

from ddct_controllers.interface import Controller
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.mpc.costs import PREVIEW
from ddct_controllers.mpc.estimators import make_observer
from ddct_controllers.mpc.model.transmission_model import transmission_model
from ddct_controllers.mpc.program.settings import MpcSettings
from ddct_controllers.mpc.qp.problem import QpSolution
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

RUN = RunSettings(load_scenario('thesis'))
MODEL = transmission_model(RUN.scenario.driveline)
MEDIAN_GOAL_US, P99_GOAL_US = 40.0, 200.0
_ROUNDS = 10
_SLOW_ROUNDS = 1


def measure() -> dict[str, Any]:
    """
    Return median and p99 of the step in us, and their ratios to ours, by implementation.

    All update with the measurements of one closed-loop run of `mpc_preview`, in turn. `skipped`
    names the libraries that are not installed.
    """
    settings = PREVIEW.settings()
    measurements = measurements_of(RUN, _controller(settings))
    ways: dict[str, tuple[Controller, int]] = {
        'ours, daqp': (_controller(settings), _ROUNDS),
        'ours, osqp': (_controller(replace(settings, backend='osqp')), _ROUNDS),
        'bare osqp': (_with_solver(settings, bare_osqp), _ROUNDS),
    }
    skipped = []
    for name, make, rounds in (
        ('cvxpy', _cvxpy, _SLOW_ROUNDS),
        ('do-mpc', _do_mpc, _SLOW_ROUNDS),
    ):
        try:
            ways[name] = (make(settings), rounds)
        except ImportError as error:
            skipped.append(f'{name} is not installed ({error})')
    times = {name: times_of(way, measurements, rounds) for name, (way, rounds) in ways.items()}
    ours = np.percentile(times['ours, daqp'], [50, 99])
    by_way = {name: compared(np.percentile(each, [50, 99]), ours) for name, each in times.items()}
    return {'ways': by_way, 'skipped': skipped}


def print_table(results: dict[str, Any]) -> None:
    """Print the results of `measure`."""
    ours = results['ways']['ours, daqp']
    met = ours['median_us'] <= MEDIAN_GOAL_US and ours['p99_us'] <= P99_GOAL_US
    print(
        f'mpc_preview step (goal: median {MEDIAN_GOAL_US:g} us, p99 {P99_GOAL_US:g} us: '
        f'{"met" if met else "MISSED"}):'
    )
    for name, row in results['ways'].items():
        print(
            f'  {name:10} median {row["median_us"]:8.1f} us ({row["median_ratio"]:6.1f}x), '
            f'p99 {row["p99_us"]:8.1f} us ({row["p99_ratio"]:6.1f}x)'
        )
    for reason in results['skipped']:
        print(f'  not compared: {reason}')


def _controller(settings: MpcSettings) -> MpcController:
    return MpcController(MODEL, make_observer(RUN, MODEL), settings)


class _Solver:
    """Backend of a controller that calls a bare function."""

    def __init__(self, solve: Callable[..., np.ndarray]) -> None:
        self._solve = solve

    def reset(self) -> None:
        """Do nothing: every program starts from the last solution."""

    def solve(self, f: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> QpSolution:
        return QpSolution(self._solve(f, lower, upper), 0, 'solved')


def _with_solver(settings: MpcSettings, make: Callable[..., Any]) -> MpcController:
    controller = _controller(settings)
    controller._solver = _Solver(make(controller.program.structure))  # type: ignore[assignment]
    return controller


def _cvxpy(settings: MpcSettings) -> MpcController:
    import cvxpy

    return _with_solver(settings, lambda structure: cvxpy_osqp_and_clarabel(cvxpy, structure)[0])


def _do_mpc(settings: MpcSettings) -> Controller:
    """
    Return do-mpc with IPOPT for the same model, weights and horizon.

    It has no control horizon: all 22 moves are free, where ours has 4.
    """
    # do-mpc warns of every optional feature that is not installed, and of deprecated numpy names.
    warnings.simplefilter('ignore')
    from do_mpc_step import DoMpcController

    return DoMpcController(MODEL, make_observer(RUN, MODEL), settings)
