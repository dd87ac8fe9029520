# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`pedal_mpc` of many runs."""

from collections.abc import Hashable, Sequence
from typing import Self

import numpy as np

from ddct_bringup.batch.controllers.interface import Measured, StackedController
from ddct_bringup.batch.controllers.observers import Observers
from ddct_bringup.batch.controllers.predictive import NEAR
from ddct_bringup.batch.stacks import by_run, distinct, product
from ddct_controllers.interface import Controller
from ddct_controllers.state_of_art.pedal_mpc import PedalMpc
from ddct_plant.scenario.settings import KnownSettings


class PedalControllers(StackedController):
    """
    The stack of `PedalMpc`, each run with the program of its horizon.

    As in `PredictiveControllers`, the solver is called where a level is not clear of zero, and a
    run whose program has no solution has the torque NaN.
    """

    fallbacks = 0

    def __init__(self, controllers: Sequence[PedalMpc]) -> None:
        """Take the controllers of R runs."""
        self._controllers = controllers
        self._observers = Observers([each.observer for each in controllers])
        self._longest = np.array([each.longest for each in controllers])
        self._shortest = np.array([each.shortest for each in controllers])
        starts = [each.control_start for each in controllers]
        self._start = np.array([np.nan if each is None else each for each in starts])
        self._before: np.ndarray | None = None

    @classmethod
    def takes(cls, controller: Controller) -> bool:
        """Return whether a controller is `pedal_mpc`."""
        return type(controller) is PedalMpc

    @classmethod
    def why_not(cls, controller: Controller) -> str:
        """Return no reason."""
        return ''

    @classmethod
    def key(cls, controller: Controller) -> Hashable:
        """Return the order of the model."""
        assert isinstance(controller, PedalMpc)
        return len(controller.observer.model.a)

    @classmethod
    def of(cls, controllers: Sequence[Controller], known: Sequence[KnownSettings]) -> Self:
        """Return the stack of such controllers."""
        return cls([each for each in controllers if isinstance(each, PedalMpc)])

    def update(self, measured: Measured) -> np.ndarray:
        """Return the first moves of the optimal requests."""
        state = self._observers.correct(measured)
        on, open_loop = measured.on, measured.open_loop_torque
        given = np.maximum(open_loop, 0.0)
        before = given if self._before is None else self._before
        horizons, slips = self._horizons_and_slips(measured)
        known = np.column_stack(
            [state, before, measured.engine_torque, measured.load_torque, slips]
        )
        optimum = product(self._maps(horizons), known)
        move = optimum[:, 0]
        clear = (optimum[:, 1:] > NEAR).all(axis=1)
        for run in np.flatnonzero(on & ~clear).tolist():
            move[run] = self._solved(run, int(horizons[run]), known[run], float(before[run]))
        request = np.where(on, np.maximum(before + move, 0.0), given)
        self._before = request
        self._observers.predict(request, measured.engine_torque, measured.load_torque)
        return np.where(on, request - open_loop, 0.0)

    def _horizons_and_slips(self, measured: Measured) -> tuple[np.ndarray, np.ndarray]:
        """Return t_r in periods and the desired slips at its end in rad/s, (R,) each."""
        first = measured.on & np.isnan(self._start)
        self._start[first] = measured.step
        since = measured.step - self._start
        started = since >= 0
        left = np.maximum(self._longest - np.where(started, since, 0), self._shortest)
        horizons = np.where(started, left, self._shortest).astype(int)
        return horizons, np.where(started, 0.0, measured.present_reference)

    def _maps(self, horizons: np.ndarray) -> np.ndarray:
        """Return the map of each run's program, or one where all are the same."""
        programs = [
            each.programs[horizon]
            for each, horizon in zip(self._controllers, horizons.tolist(), strict=True)
        ]
        first, places = distinct(map(id, programs))
        return by_run([programs[index].without_rows for index in first], places)

    def _solved(self, run: int, horizon: int, known: np.ndarray, before: float) -> float:
        """Return the first move of one run's program in N m, NaN without a solution."""
        if not np.isfinite(known).all():
            return np.nan
        controller = self._controllers[run]
        controller.reset()
        return float(controller.solve(horizon, known, before).z[0])
