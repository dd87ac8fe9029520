# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller whose plates lock and part all the time."""

from gaming_parts import Gamed, slam

from ddct_controllers.interface import Measurement

HALF_PERIODS = 7


class Chatter(Gamed):
    """Games the first lock: it closes and half opens the clutch in turns of 70 ms."""

    base = 'ls8'

    def clutch(self, measurement: Measurement, request: float) -> float:
        closes = measurement.step // HALF_PERIODS % 2 == 0
        return slam(measurement) if closes else 0.5 * max(measurement.open_loop_torque, 0.0)
