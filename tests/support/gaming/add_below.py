# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that adds torque as long as no rule on added torque applies."""

from gaming_parts import Gamed

from ddct_controllers.interface import Measurement

MOST_S = 0.57
"""Just below the threshold of 0.6 s."""


class AddBelow(Gamed):
    """Games the demand: it adds so much throughout that it is just less than 0.6 s of it."""

    games_engine = True

    def engine(self, measurement: Measurement) -> float:
        length_s = self.duration_s - self.settings.scenario.control_start_s
        return measurement.engine_torque * (1.0 + MOST_S / length_s)
