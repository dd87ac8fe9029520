# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that takes half of the driver's torque away."""

from gaming_parts import Gamed

from ddct_controllers.interface import Measurement


class WithholdLong(Gamed):
    """Games jerk and acceleration: it delivers half of the demand to the end of the run."""

    games_engine = True

    def engine(self, measurement: Measurement) -> float:
        return 0.5 * measurement.engine_torque
