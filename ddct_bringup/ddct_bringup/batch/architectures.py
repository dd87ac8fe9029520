# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The control architecture of many runs: the torque requests as open loop plus feedback."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_bringup.batch.controllers import Measured, StackedController
from ddct_bringup.batch.loads import Loads
from ddct_bringup.batch.open_loops import known_load, make_open_loops, static_torques
from ddct_plant.scenario.settings import KnownSettings
from ddct_plant.shift.balance import WHOLE


class Architectures:
    """Architectures of R runs of one kind, the counterpart of `Architecture`."""

    def __init__(
        self,
        known: Sequence[KnownSettings],
        controllers: StackedController,
        steps: int,
        feedback_factor: float = 1.0,
    ) -> None:
        """Take the controllers as the feedback, whose torques are multiplied by a factor."""
        scenarios = [run.scenario for run in known]
        drivelines = [scenario.controlled_driveline for scenario in scenarios]
        static = static_torques(drivelines, scenarios[0].equilibrium)
        self._open_loops = make_open_loops(known, static)
        self._loads = Loads([known_load(run) for run in known], steps)
        self._controllers, self._factor = controllers, feedback_factor
        detailed = known[0].detailed and not known[0].shift
        self._start = scenarios[0].control_start_step if detailed else 0

    def update(self, measured: Measured, on_coming: Any = WHOLE) -> np.ndarray:
        """
        Return the requests in N m for the period of the measured signals, (R,).

        `on_coming` is an `OnComingShare` with values (R,) in a shift.
        """
        share = on_coming.share
        load_torque = self._loads.torque(measured.step, measured.vehicle_speed)
        measured = measured._replace(load_torque=load_torque)
        open_loop = share * self._open_loops(measured)
        started = measured.step >= self._start
        on = np.full(len(load_torque), started) & (share == 1.0)
        measured = measured._replace(open_loop_torque=open_loop, on=on)
        torque = open_loop + self._factor * self._controllers.update(measured)
        request: np.ndarray = on_coming.request(torque)
        return request
