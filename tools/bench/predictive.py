# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time of an update of `mpc_preview` and of its programs, beside OSQP and do-mpc."""

import statistics
import time
import warnings
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
import osqp
from scipy import sparse

from bench.ratios import Comparison, Cost, NotMeasured
from ddct_bringup.run.headless import run_headless
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.mpc.controller import MpcController
from ddct_controllers.mpc.costs import PREVIEW
from ddct_controllers.mpc.estimators import make_observer
from ddct_controllers.mpc.model.transmission_model import transmission_model
from ddct_controllers.mpc.qp.backend import DEFAULT_BACKEND, make_backend
from ddct_controllers.mpc.qp.problem import QpStructure
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

RUN = RunSettings(KnownSettings(load_scenario('thesis')))
MODEL = transmission_model(RUN.scenario.driveline)
Program = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Gradient and bounds of one program, which change from step to step; the matrices stay."""
Solve = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]
_LIMIT = 20_000
"""Limit of iterations, which no solver reaches."""
_TOLERANCE = 1e-3
"""Largest difference of moves of two solvers whose times are compared, of the largest move."""


class _Recording(Controller):
    """Controller that stores its measurements, and the programs of the predictive one in it."""

    def __init__(self) -> None:
        self.controller = _preview()
        self.preview_steps = self.controller.preview_steps
        self.held: list[Measurement] = []
        self.updated: list[Measurement] = []
        self.programs: list[Program] = []
        solver: Any = self.controller.solver
        self._solve = solver.solve
        solver.solve = self._record

    def reset(self) -> None:
        self.controller.reset()

    def hold(self, measurement: Measurement) -> None:
        self.held.append(measurement)
        self.controller.hold(measurement)

    def update(self, measurement: Measurement) -> Command:
        self.updated.append(measurement)
        return self.controller.update(measurement)

    def _record(self, *program: np.ndarray) -> Any:
        self.programs.append(tuple(np.array(each) for each in program))  # type: ignore[arg-type]
        return self._solve(*program)


def _preview() -> MpcController[Any]:
    return MpcController(MODEL, make_observer(RUN.known, MODEL), PREVIEW.settings())


def _recorded() -> _Recording:
    """Return the measurements and programs of a run."""
    recording = _Recording()
    run_headless(RUN, recording)
    return recording


def _update_s(controller: Controller, run: _Recording) -> float:
    """Return the median time in s of the updates with the measurements of a run."""
    controller.reset()
    for measurement in run.held:
        controller.hold(measurement)
    return _median_s(controller.update, [(each,) for each in run.updated])


def _median_s(call: Callable[..., object], arguments: Sequence[tuple[Any, ...]]) -> float:
    times = []
    for each in arguments:
        started = time.perf_counter()
        call(*each)
        times.append(time.perf_counter() - started)
    return statistics.median(times)


def _backend(name: str, structure: QpStructure) -> Solve:
    made = make_backend(name, structure, _LIMIT)
    return lambda f, lower, upper: made.solve(f, lower, upper).z


def _bare_osqp(structure: QpStructure) -> Solve:
    """Return OSQP without our scaling and checks; all settings but the accuracy are defaults."""
    rows, size = structure.constraints.shape
    cost = sparse.triu(structure.hessian, format='csc')
    bound = np.full(rows, np.inf)
    solver = osqp.OSQP()
    accuracy = {'eps_abs': 1e-6, 'eps_rel': 1e-6, 'max_iter': _LIMIT}
    constraints = sparse.csc_matrix(structure.constraints)
    solver.setup(cost, np.zeros(size), constraints, -bound, bound, verbose=False, **accuracy)

    def solve(f: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
        solver.update(q=f, l=lower, u=upper)
        return np.asarray(solver.solve(raise_error=True).x)

    return solve


def _solvers(make: Callable[[QpStructure], Solve]) -> tuple[Cost, Cost]:
    """Return the times of both solvers with the programs of a run; require equal solutions."""
    run = _recorded()
    structure = run.controller.program.structure
    ours, theirs = _backend(DEFAULT_BACKEND, structure), make(structure)
    found, expected = (np.array([each(*step) for step in run.programs]) for each in (theirs, ours))
    np.testing.assert_allclose(found, expected, atol=_TOLERANCE * np.abs(expected).max())
    return partial(_median_s, ours, run.programs), partial(_median_s, theirs, run.programs)


def _beside_do_mpc() -> tuple[Cost, Cost]:
    # do-mpc warns of every optional feature that is not installed, and of deprecated numpy names.
    warnings.simplefilter('ignore')
    try:
        from bench.do_mpc_step import DoMpcController
    except ImportError as error:
        raise NotMeasured(f'{error}: make setup EXTRAS=bench') from error
    run = _recorded()
    peer = DoMpcController(MODEL, make_observer(RUN.known, MODEL), PREVIEW.settings())
    return partial(_update_s, _preview(), run), partial(_update_s, peer, run)


_QP = 'program of mpc_preview, solve'
PREDICTIVE = [
    Comparison(_QP, 'OSQP bare', partial(_solvers, _bare_osqp)),
    Comparison(_QP, 'our backend for OSQP', partial(_solvers, partial(_backend, 'osqp'))),
    # do-mpc has no control horizon: all 22 moves are free, where ours has 4.
    Comparison('mpc_preview, update', 'do-mpc with IPOPT', _beside_do_mpc),
]
