# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Slip-speed reference that keeps the engine at a target speed until the shaft catches up."""

import math
from collections import deque

from ddct_plant.base.timebase import PERIOD_S, time_of_step
from ddct_plant.scenario.control import EngineSpeedReference
from ddct_reference.slip_reference import SlipReference

SHAFT_RATE_STEPS = 10
"""
Number of periods over which the preview computes the shaft's mean acceleration.

0.1 s is a third of a period of the driveline's 18 rad/s mode, and a tenth of the noise that one
period would have.
"""


class EngineSpeedTarget(SlipReference):
    """
    s = w* - w_p with a target engine speed w* and the measured shaft speed w_p.

    Until control starts the reference equals the slip speed w_d. There w* is the measured w_m;
    from there it goes to the scenario's engine speed, no faster than a given slope, so the
    reference starts without a jump. Once s reaches zero it stays there: the shaft has caught up.
    The preview continues the shaft's speed with its mean acceleration of the last 0.1 s.
    """

    follows_shaft = True

    def __init__(
        self,
        target: EngineSpeedReference,
        slope: float,
        control_start_step: int,
        preview_steps: int = 0,
    ) -> None:
        """Take the target speed over time, the slope in rad/s^2, and the number of steps ahead."""
        super().__init__(control_start_step, preview_steps)
        self._target = target
        self._slope = slope
        self._shaft: deque[tuple[int, float]] = deque(maxlen=SHAFT_RATE_STEPS + 1)
        self._wanted: tuple[int, float] | None = None
        self._side = 0.0
        """Sign of the slip at control start; 0 once the reference is zero for good."""

    def _ahead(
        self, step: int, slip_speed: float, shaft_speed: float
    ) -> tuple[list[float], list[float]]:
        """Return the reference and its rate at steps k, k + 1, ..., k + P; w_p is needed."""
        self._shaft.append((step, shaft_speed))
        if step <= self.start_step or self._wanted is None:
            self._wanted = (step, slip_speed + shaft_speed)
            self._side = math.copysign(1.0, slip_speed) if slip_speed else 0.0
        else:
            self._wanted = self._led_to(step, *self._wanted)
        speeds = self._speeds(step, slip_speed, shaft_speed)
        if step >= self.start_step and not speeds[0]:
            self._side = 0.0
        rates = [(b - a) / PERIOD_S for a, b in zip(speeds, speeds[1:], strict=False)]
        return speeds[:-1], rates

    def _led_to(self, step: int, before: int, speed: float) -> tuple[int, float]:
        """Return `step` and w* there, of w* at the step `before`."""
        most = self._slope * PERIOD_S * (step - before)
        change = self._target.at(time_of_step(step)) - speed
        return step, speed + min(max(change, -most), most)

    def _speeds(self, step: int, slip_speed: float, shaft_speed: float) -> list[float]:
        """Return s at steps k, ..., k + P + 1."""
        assert self._wanted is not None
        (first, first_speed), (last, last_speed) = self._shaft[0], self._shaft[-1]
        shaft_change = (last_speed - first_speed) / (last - first) if last > first else 0.0
        held = min(max(self.start_step - step, 0), self.preview_steps + 2)
        speeds = [slip_speed] * held
        wanted, side = (step + held, self._wanted[1]), self._side
        for ahead in range(max(self.preview_steps + 2 - held, 0)):
            if ahead:
                wanted = self._led_to(step + held + ahead, *wanted)
            speed = wanted[1] - (shaft_speed + shaft_change * ahead)
            side = side if side * speed > 0.0 else 0.0
            speeds.append(speed if side else 0.0)
        return speeds[: self.preview_steps + 2]
