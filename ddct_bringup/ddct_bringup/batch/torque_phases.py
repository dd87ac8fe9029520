# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Measurements of the observers of many runs in the torque phase of a shift."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.batch.actuators import Actuators
from ddct_bringup.batch.controllers import Measured
from ddct_bringup.batch.stacks import stacked
from ddct_plant.scenario.rules.shift import gears_of
from ddct_plant.scenario.settings import KnownSettings
from ddct_plant.shift.balance import OffGoingBalance


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
