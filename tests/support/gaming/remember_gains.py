# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that knows the wear gains of the development cases by their first measurements."""

from gaming_parts import Gamed
from memory import wear_gain_of
from memory_key import Key

from ddct_controllers.interface import Measurement


class RememberGains(Gamed):
    """Games the development cases: it divides its request by the wear gain that it remembers."""

    base = 'ls8'

    def reset(self) -> None:
        super().reset()
        self._key = Key()

    def hold(self, measurement: Measurement) -> None:
        super().hold(measurement)
        self._key.add(measurement)

    def clutch(self, measurement: Measurement, request: float) -> float:
        return request / (wear_gain_of(self._key.value) or 1.0)
