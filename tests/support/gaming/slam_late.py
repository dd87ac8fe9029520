# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that lets the plates slip until no window looks, and closes them then."""

from gaming_parts import Gamed, slam

from ddct_controllers.interface import Measurement
from ddct_plant.base.timebase import time_of_step


class SlamLate(Gamed):
    """Games windows: constant slip until 2 s or 0.7 s before the end, then a slam."""

    base = 'ls8'

    def clutch(self, measurement: Measurement, request: float) -> float:
        at_s = min(2.0, self.duration_s - 0.7)
        late = time_of_step(measurement.step) >= at_s
        return slam(measurement) if late else measurement.open_loop_torque
