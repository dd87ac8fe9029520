# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that gives the car more torque than the driver demands."""

from gaming_parts import Gamed

from ddct_controllers.interface import Measurement


class AddLong(Gamed):
    """Games the response: it commands 1.8 times the demand to the end of the run."""

    games_engine = True

    def engine(self, measurement: Measurement) -> float:
        return 1.8 * measurement.engine_torque
