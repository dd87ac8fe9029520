# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that locks early, and opens the clutch again."""

from gaming_parts import Gamed, slam

from ddct_controllers.interface import Measurement
from ddct_plant.base.timebase import PERIOD_S

OPEN_S = 0.15


class Reopen(Gamed):
    """Games figures that end with the first lock: it slams, opens for 0.15 s, and locks again."""

    base = 'ls8'

    def reset(self) -> None:
        super().reset()
        self._open_s, self._done = 0.0, False

    def clutch(self, measurement: Measurement, request: float) -> float:
        if self.locked and not self._done:
            self._open_s, self._done = OPEN_S, True
        self._open_s -= PERIOD_S
        if self._open_s > 0.0:
            return 0.0
        return max(request, slam(measurement))
