# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Predictive controllers of many runs, the counterpart of `MpcController`."""

from collections.abc import Hashable, Sequence
from typing import Any, Self

import numpy as np

from ddct_bringup.batch.controllers.interface import Measured, StackedController
from ddct_bringup.batch.controllers.observers import Observers, WearObservers
from ddct_bringup.batch.stacks import by_run, distinct, product
from ddct_controllers.interface import Controller
from ddct_controllers.mpc.controller import MpcController, references
from ddct_controllers.mpc.estimate.observer import Observer
from ddct_controllers.mpc.estimate.wear_observer import WearObserver
from ddct_controllers.mpc.inputs import CLUTCH, reaches_level
from ddct_controllers.mpc.qp.backend import DEFAULT_BACKEND
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.scenario.settings import KnownSettings

_NEAR = 1e-9
"""Distance of a row to its bound, relative above 1, from which on the solver decides."""
_STACKS: dict[type, type[Observers] | type[WearObservers]] = {
    Observer: Observers,
    WearObserver: WearObservers,
}


class PredictiveControllers(StackedController):
    """
    Predictive controllers that decide the clutch torque, all of one horizon and one set of rows.

    The optimum without rows is a linear map. Where all rows are clear of their bounds, it is the
    optimum of the program; else the solver of the controller finds it, each time afresh, so that
    no other program has an effect on it. A run whose program has no solution has the torque NaN:
    it has to go on with its last plan, step by step.
    """

    fallbacks = 0

    def __init__(self, controllers: Sequence[MpcController[Any]]) -> None:
        """Take the controllers of R runs; those with one program share its map and solver."""
        first, places = distinct(id(each.program) for each in controllers)
        kinds = [controllers[index] for index in first]
        self._kinds, self._places = kinds, places
        self._settings = kinds[0].settings
        self._map = by_run([each.program.without_rows for each in kinds], places)
        self._lower, self._upper = (
            np.array([getattr(each.program, name) for each in kinds])[places]
            for name in ('lower', 'upper')
        )
        self._soft = np.asarray(kinds[0].program.structure.soft)
        clutch = [each.settings.inputs[CLUTCH] for each in kinds]
        limits = [(each.lowest, each.highest, each.rate_n_m_s * PERIOD_S) for each in clutch]
        self._limits = np.array(limits)[places].T
        observers = [each.observer for each in controllers]
        self._observers: Any = _STACKS[type(observers[0])](observers)
        self._own_torque = np.zeros(len(controllers))
        self._before: np.ndarray | None = None

    @classmethod
    def takes(cls, controller: Controller) -> bool:
        """Return whether a controller is a `MpcController` without own code."""
        return type(controller) is MpcController

    @classmethod
    def why_not(cls, controller: Controller) -> str:
        """Return why the programs of a controller are not solved here, empty if they are."""
        assert isinstance(controller, MpcController)
        settings = controller.settings
        if settings.backend != DEFAULT_BACKEND:
            return f'the solver of its programs is {settings.backend}'
        if settings.iteration_limit is not None:
            return 'the iterations of its solver are limited'
        return ''

    @classmethod
    def key(cls, controller: Controller) -> Hashable:
        """Return kind and sizes of observer and program, and what they weigh."""
        assert isinstance(controller, MpcController)
        observer, settings, program = controller.observer, controller.settings, controller.program
        starts = isinstance(observer, WearObserver) or observer.start is not None
        return (
            (type(observer), starts, program.without_rows.shape, settings.control_steps),
            tuple(each.output for each in settings.outputs),
            (settings.prediction_steps, settings.preview, settings.along_tangent),
            np.asarray(program.structure.soft).tobytes(),
        )

    @classmethod
    def of(cls, controllers: Sequence[Controller], known: Sequence[KnownSettings]) -> Self:
        """Return the stack of such controllers."""
        return cls([each for each in controllers if isinstance(each, MpcController)])

    def update(self, measured: Measured) -> np.ndarray:
        """Return the first moves of the optimum over the horizon, and predict their effect."""
        state = self._observers.correct(measured)
        gain, open_loop = self._observers.wear_gain, measured.open_loop_torque
        given = np.maximum(open_loop, 0.0)
        jump = open_loop - (given if self._before is None else self._before)
        level = open_loop + self._own_torque
        known = np.column_stack(
            [
                *(state, level, measured.engine_torque / gain, measured.load_torque / gain),
                *(open_loop, self._references(measured, gain), jump),
            ]
        )
        optimum = product(self._map, known)
        on, last, move = measured.on, level - jump, optimum[:, 0]
        for run in np.flatnonzero(on & ~self._clear(optimum[:, 1:], last, gain)).tolist():
            move[run] = self._solved(run, known[run], float(last[run]), float(gain[run]))
        request = level + move
        torque = np.where(on, request - open_loop, 0.0)
        self._own_torque, self._before = torque, np.where(on, open_loop, given)
        self._observers.predict(
            np.where(on, np.maximum(request, 0.0), given),
            measured.engine_torque,
            measured.load_torque,
        )
        return torque

    def _references(self, measured: Measured, gain: np.ndarray) -> np.ndarray:
        speeds, rates = measured.slip_reference, measured.slip_reference_rate
        values = references(self._settings, speeds, rates) / gain[:, np.newaxis, np.newaxis]
        return values.reshape(len(values), -1)

    def _clear(self, rows: np.ndarray, last: np.ndarray, gain: np.ndarray) -> np.ndarray:
        """Return whether all rows are within their bounds, for the request before in N m, (R,)."""
        divisor = np.where(self._soft, gain[:, np.newaxis], 1.0)
        lower, upper = self._lower / divisor, self._upper / divisor
        with np.errstate(invalid='ignore'):  # a bound that is infinite has no distance
            below = rows - lower > _NEAR * np.maximum(np.abs(lower), 1.0)
            above = upper - rows > _NEAR * np.maximum(np.abs(upper), 1.0)
        within = (below | (lower == -np.inf)) & (above | (upper == np.inf))
        return within.all(axis=1) & reaches_level(last, *self._limits)

    def _solved(self, run: int, known: np.ndarray, last: float, gain: float) -> float:
        """Return the first move of one run's program in N m, NaN without a solution."""
        if not np.isfinite(known).all():
            return np.nan
        controller = self._kinds[self._places[run]]
        program, jump = controller.program, known[-1:]
        v = known[: program.shift.shape[1] - len(jump)]
        shift = program.shift @ np.concatenate((v, jump))
        lower, upper = controller.clutch.bounds(last, gain)
        controller.solver.reset()
        f = program.gradient @ known[: -len(jump)]
        solution = controller.solver.solve(f, lower - shift, upper - shift)
        return float(solution.z[0])
