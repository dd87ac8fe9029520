# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The control architecture of many runs: the torque requests as open loop plus feedback."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.closing import ClosingStages
from ddct_bringup.batch.controllers.interface import Feedback, Measured
from ddct_bringup.batch.open_loops import known_load, make_open_loops, static_torques
from ddct_bringup.batch.plant.actuators import Actuators
from ddct_bringup.batch.plant.plants import Loads
from ddct_bringup.batch.stacks import stacked
from ddct_plant.scenario.rules.shift import gears_of
from ddct_plant.scenario.settings import KnownSettings
from ddct_plant.shift.balance import WHOLE, OffGoingBalance


class TorquePhases:
    """The counterpart of `TorquePhase` for R shifts."""

    def __init__(self, known: Sequence[KnownSettings], steps: int) -> None:
        """Start with the on-coming actuators at rest on a request of zero, for `steps` periods."""
        scenarios = [run.scenario for run in known]
        self._balance = stacked([OffGoingBalance.of(gears_of(each)) for each in scenarios])
        actuators = [each.actuator for each in scenarios]
        self._actuators = Actuators(actuators, np.zeros(len(known)), steps)

    def measured(self, measured: Measured, share: np.ndarray) -> Measured:
        """
        Return the measured signals of a period, those of runs whose share is below 1 changed.

        It is called in each period, until no share is below 1.
        """
        requested = np.where(share < 1.0, measured.open_loop_torque, 0.0)
        carried = self._balance.torque(
            measured.engine_torque,
            measured.load_torque,
            measured.engine_speed,
            self._actuators.mean_torque(measured.step, requested),
        )
        wheel_torque = self._balance.off_going.wheel_torque(carried)
        shifting = share < 1.0
        return measured._replace(
            load_torque=measured.load_torque - np.where(shifting, wheel_torque, 0.0),
            engine_torque=measured.engine_torque - np.where(shifting, carried, 0.0),
        )


class Architectures:
    """Architectures of R runs of one kind, the counterpart of `Architecture`."""

    def __init__(
        self,
        known: Sequence[KnownSettings],
        controllers: Feedback,
        steps: int,
        feedback_factor: float = 1.0,
    ) -> None:
        """Take the controllers as the feedback, whose torques are multiplied by a factor."""
        scenarios = [run.scenario for run in known]
        drivelines = [scenario.controlled_driveline for scenario in scenarios]
        static = static_torques(drivelines, [each.equilibrium for each in scenarios])
        self._open_loops = make_open_loops(known, static)
        self._loads = Loads([known_load(run) for run in known], steps)
        self._controllers, self._factor = controllers, feedback_factor
        closing = any(each.closing for each in scenarios)
        self._closing = ClosingStages(scenarios, static) if closing else None
        detailed = known[0].detailed and not known[0].shift
        self._start = np.array([each.control_start_step if detailed else 0 for each in scenarios])
        self._torque_phases = TorquePhases(known, steps + 1) if known[0].shift else None
        self._last_request = np.zeros(len(known))
        self.fed = np.zeros(len(known), dtype=bool)
        """Whether feedback has been on, (R,)."""

    def load_torque(self, step: int, vehicle_speed: Any) -> np.ndarray:
        """Return C_load in N m of everything that resists, (R,), at V_x in m/s."""
        return self._loads.torque(step, vehicle_speed)

    def update(
        self, measured: Measured, running: np.ndarray, on_coming: Any = WHOLE
    ) -> np.ndarray:
        """
        Return the requests in N m for the period of the measured signals, (R,).

        Feedback is off in runs that do not run any more, (R,). `on_coming` is an `OnComingShare`,
        in a shift with values (R,).
        """
        share = on_coming.share
        load_torque = self.load_torque(measured.step, measured.vehicle_speed)
        measured = measured._replace(load_torque=load_torque)
        open_loop = share * self._open_loops(measured)
        on = running & (measured.step >= self._start) & (share == 1.0)
        if self._closing:
            added = self._closing.update(measured, open_loop, self._last_request, on)
            open_loop = np.where(self._closing.there, open_loop + added, open_loop)
            on = on & ~self._closing.closed
        measured = measured._replace(open_loop_torque=open_loop, on=on)
        self.fed |= on
        if self._torque_phases and (share < 1.0).any():
            measured = self._torque_phases.measured(measured, share)
        feedback = self._factor * self._controllers.update(measured)
        self._last_request = open_loop + feedback
        request: np.ndarray = on_coming.request(self._last_request)
        return request
