# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time of one step of `mpc_preview`, that is filter, program and command, beside peers."""

import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from bench.peers.numpy_loop import NAME, numpy_loop_s
from bench.peers.qp_peers import bare_daqp, bare_osqp, cvxpy_osqp
from bench.peers.qp_programs import Step
from bench.peers.qp_solvers import percentiles, solve_times
from bench.peers.replay import Measurements, measurements_of, times_of
from bench.skeleton.comparison import Bench, Comparison, Sides, comparison, curve, extra

from ddct_controllers.interface import Controller
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.mpc.costs import PREVIEW
from ddct_controllers.mpc.estimators import make_observer
from ddct_controllers.mpc.model.transmission_model import transmission_model
from ddct_controllers.mpc.program.settings import MpcSettings
from ddct_controllers.mpc.qp.problem import QpSolution, QpStructure
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

RUN = RunSettings(load_scenario('thesis'))
MODEL = transmission_model(RUN.scenario.driveline)


def controller_with(settings: MpcSettings) -> MpcController:
    """Return `mpc_preview` with other settings."""
    return MpcController(MODEL, make_observer(RUN, MODEL), settings)


def update_times(controller: Controller, measurements: Measurements) -> Mapping[str, float]:
    """Return median and p99 in s of the updates with the measurements of a run."""
    return percentiles(times_of(controller, measurements))


@comparison('mpc_preview, update', 'DAQP bare on the same programs')
def beside_bare_daqp(bench: Bench) -> Iterator[Sides]:
    """Wall time of an update; the reference solves its programs and does nothing else."""
    controller = controller_with(PREVIEW.settings())
    measurements = measurements_of(RUN, controller)
    programs: list[Step] = []
    recording = controller_with(PREVIEW.settings())
    recording._solver = _Recording(recording._solver, programs)  # type: ignore[assignment]
    times_of(recording, measurements)
    solve = bare_daqp(controller.program.structure)
    yield Sides(
        lambda: update_times(controller, measurements), lambda: solve_times(solve, programs)
    )


@curve('mpc_preview, update', NAME, 'prediction steps', (5, 10, 22, 50, 100, 200))
def over_the_horizon(bench: Bench, steps: int) -> Iterator[Sides]:
    """Median wall time of an update, over the steps of the prediction."""
    controller = controller_with(replace(PREVIEW.settings(), prediction_steps=steps))
    measurements = measurements_of(RUN, controller)
    yield Sides(lambda: update_times(controller, measurements)['median'], numpy_loop_s)


def _peer(reference: str, make: Callable[[MpcSettings], Controller]) -> Comparison:
    @comparison('mpc_preview, update', reference)
    def sides(bench: Bench) -> Iterator[Sides]:
        """Wall time of an update with the measurements of one closed-loop run."""
        settings = PREVIEW.settings()
        ours, peer = controller_with(settings), make(settings)
        measurements = measurements_of(RUN, ours)
        yield Sides(
            lambda: update_times(ours, measurements), lambda: update_times(peer, measurements)
        )

    return sides


class _Solver:
    """Backend of a controller that calls a bare function."""

    def __init__(self, solve: Callable[..., np.ndarray]) -> None:
        self._solve = solve

    def reset(self) -> None:
        """Do nothing: every program starts from the last solution."""

    def solve(self, f: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> QpSolution:
        """Return the solution of the bare function."""
        return QpSolution(self._solve(f, lower, upper), 0, 'solved')


class _Recording:
    """Backend that stores the vectors of each program and passes them to another backend."""

    def __init__(self, backend: Any, programs: list[Step]) -> None:
        self._backend, self._programs = backend, programs

    def reset(self) -> None:
        """Reset the other backend."""
        self._backend.reset()

    def solve(self, f: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> QpSolution:
        """Return the solution of the other backend."""
        self._programs.append(Step(*(np.array(each, dtype=float) for each in (f, lower, upper))))
        return self._backend.solve(f, lower, upper)


def _with_solver(make: Callable[[QpStructure], Any]) -> Callable[[MpcSettings], MpcController]:
    def made(settings: MpcSettings) -> MpcController:
        controller = controller_with(settings)
        controller._solver = _Solver(make(controller.program.structure))  # type: ignore[assignment]
        return controller

    return made


def _do_mpc(settings: MpcSettings) -> Controller:
    """
    Return do-mpc with IPOPT for the same model, weights and horizon.

    It has no control horizon: all 22 moves are free, where ours has 4.
    """
    # do-mpc warns of every optional feature that is not installed, and of deprecated numpy names.
    warnings.simplefilter('ignore')
    extra('do_mpc')
    from bench.peers.do_mpc_step import DoMpcController

    return DoMpcController(MODEL, make_observer(RUN, MODEL), settings)


PEERS = (
    _peer('mpc_preview with OSQP', lambda s: controller_with(replace(s, backend='osqp'))),
    _peer('mpc_preview with OSQP bare', _with_solver(bare_osqp)),
    _peer('mpc_preview with cvxpy', _with_solver(lambda s: cvxpy_osqp(extra('cvxpy'), s))),
    _peer('do-mpc with IPOPT', _do_mpc),
)
