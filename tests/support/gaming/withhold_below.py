# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that withholds torque as long as no rule on withheld torque applies."""

from gaming_parts import Gamed

from ddct_controllers.interface import Measurement
from ddct_plant.base.timebase import PERIOD_S

MOST_S = 0.57
"""Just below the threshold of 0.6 s."""
SHARE, RETURN_N_M_S = 0.45, 120.0


class WithholdBelow(Gamed):
    """Games the jerk: it withholds torque for just less than 0.6 s, and gives it back slowly."""

    games_engine = True

    def reset(self) -> None:
        super().reset()
        self._withheld = self._largest = self._missing = 0.0
        self._returns = False

    def engine(self, measurement: Measurement) -> float:
        demand = measurement.engine_torque
        self._largest = max(self._largest, demand)
        to_return = self._missing**2 / (2.0 * RETURN_N_M_S)
        self._returns |= self._withheld + to_return >= MOST_S * self._largest
        if self._returns:
            self._missing = max(self._missing - RETURN_N_M_S * PERIOD_S, 0.0)
        else:
            self._missing = SHARE * demand
        self._withheld += self._missing * PERIOD_S
        return demand - self._missing
