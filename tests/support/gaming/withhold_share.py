# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that always withholds as much as both thresholds allow."""

from gaming_parts import Gamed

from ddct_controllers.interface import Measurement

MOST_S, MOST_SHARE = 0.57, 0.19
"""Just below the thresholds: 0.6 s, and a fifth of the demand at the end."""


class WithholdShare(Gamed):
    """Games both thresholds: it delivers just above 0.8 of the demand throughout."""

    games_engine = True

    def engine(self, measurement: Measurement) -> float:
        length_s = self.duration_s - self.settings.scenario.control_start_s
        return measurement.engine_torque * (1.0 - min(MOST_SHARE, MOST_S / length_s))
