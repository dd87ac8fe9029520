# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that never lets the plates meet."""

from gaming_parts import Gamed

from ddct_controllers.interface import Measurement
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rad_s_from_rpm

INERTIA, RATE, FASTEST_RAD_S2 = 0.2, 3.0, 90.0
"""J_r in kg m^2, the rate at which the slip approaches, 1/s, and its largest slope."""
INTEGRAL = 0.5
"""N m per rad/s and s, for a clutch that is worn."""


class Creep(Gamed):
    """Games the lock: it keeps about 9 rpm of slip, where no closing stage closes the plates."""

    base = 'ls8'

    def reset(self) -> None:
        super().reset()
        self._offset = 0.0
        closing = self.settings.scenario.closing
        band = 1.05 * closing.slip_band_rad_s if closing else 0.0
        self._least = max(rad_s_from_rpm(9.0), band)

    def clutch(self, measurement: Measurement, request: float) -> float:
        beyond = measurement.slip_speed - self._least
        if abs(beyond) < 5.0:
            self._offset += INTEGRAL * beyond * PERIOD_S
        slope = min(RATE * beyond, FASTEST_RAD_S2)
        return measurement.open_loop_torque + INERTIA * slope + self._offset
