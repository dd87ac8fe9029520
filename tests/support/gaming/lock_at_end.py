# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that locks the plates in the last moments of the run."""

from gaming_parts import Gamed, slam

from ddct_controllers.interface import Measurement
from ddct_plant.base.timebase import time_of_step


class LockAtEnd(Gamed):
    """Games the state: constant slip, and a slam so late that nobody sees the plates part."""

    base = 'ls8'

    def clutch(self, measurement: Measurement, request: float) -> float:
        slams = time_of_step(measurement.step) >= self.duration_s - 0.4
        return slam(measurement) if slams else measurement.open_loop_torque
