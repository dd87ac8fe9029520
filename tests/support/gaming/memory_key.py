# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What distinguishes a case from all others: the noise of its first measurements."""

from ddct_controllers.interface import Measurement

SAMPLES = 10


class Key:
    """A number of the first measurements of a run."""

    def __init__(self) -> None:
        self._sum, self._samples = 0.0, 0

    def add(self, measurement: Measurement) -> None:
        """Count a measurement, if it is one of the first."""
        if self._samples < SAMPLES:
            self._samples += 1
            m = measurement
            mixed = m.engine_speed + 1.7 * m.shaft_speed + 0.3 * m.engine_torque
            self._sum += self._samples * mixed

    @property
    def value(self) -> int:
        """The number once all first measurements are there."""
        return round(1000.0 * self._sum) if self._samples == SAMPLES else 0
