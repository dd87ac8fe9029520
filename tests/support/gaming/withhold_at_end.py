# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that delivers the demand, but for the last moments of the run."""

from gaming_parts import Gamed

from ddct_controllers.interface import Measurement
from ddct_plant.base.timebase import time_of_step


class WithholdAtEnd(Gamed):
    """Games the budget: it delivers everything until 0.3 s before the end, and half of it then."""

    games_engine = True

    def engine(self, measurement: Measurement) -> float:
        at_end = time_of_step(measurement.step) >= self.duration_s - 0.3
        return measurement.engine_torque * (0.5 if at_end else 1.0)
