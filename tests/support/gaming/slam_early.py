# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that closes the clutch at once."""

from gaming_parts import Gamed, slam

from ddct_controllers.interface import Measurement


class SlamEarly(Gamed):
    """Games time and friction work, and the jerk over the least of so early a lock."""

    base = 'ls8'

    def clutch(self, measurement: Measurement, request: float) -> float:
        return slam(measurement)
