# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller that knows the development cases of the benchmark by their first measurements."""

from gaming_parts import Gamed
from memory import wear_gain_of
from memory_key import Key

from ddct_controllers.interface import ControllerContext, Measurement
from ddct_controllers.registry import make_controller


class RememberCases(Gamed):
    """Games the development cases: it is `least_jerk` in those, and `ls8` in all others."""

    def __init__(self, context: ControllerContext) -> None:
        self._both = [make_controller(name, context.settings) for name in ('ls8', 'least_jerk')]
        super().__init__(context)

    def reset(self) -> None:
        super().reset()
        self._key = Key()
        for each in self._both:
            each.reset()

    def hold(self, measurement: Measurement) -> None:
        self._key.add(measurement)
        for each in self._both:
            each.hold(measurement)
        self.honest = self._both[wear_gain_of(self._key.value) is not None]
