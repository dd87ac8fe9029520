"""CRF's reference generator: follow the slip speed, then ramp it to zero (Section 1.4.1)."""

import math

from ddct_plant.timebase import PERIOD_S


class CrfRamp:
    """
    Slip-speed reference of the detailed architecture.

    The output equals w_d until control starts. From then on each value depends on the one before:
    it runs at a constant slope to zero, from either side, and stays there (Figures 1.11, 1.12).
    """

    def __init__(self, slope: float, control_start_step: int, preview_steps: int = 0) -> None:
        """Take the slope in rad/s^2, the first controlled step and the steps to look ahead."""
        self._slope = slope
        self._start_step = control_start_step
        self._preview_steps = preview_steps
        self._start_value: float | None = None

    def update(self, step: int, slip_speed: float) -> tuple[list[float], list[float]]:
        """
        Return the reference in rad/s and its rate in rad/s^2 at steps k, k + 1, ..., k + P.

        Until control starts, the preview assumes that the ramp begins from the slip speed of now.
        """
        if step <= self._start_step or self._start_value is None:
            self._start_value = slip_speed
        first = step - self._start_step
        ramp = [self._ramp(first + ahead) for ahead in range(self._preview_steps + 1)]
        speeds, rates = zip(*ramp, strict=True)
        return list(speeds), list(rates)

    def _ramp(self, steps: int) -> tuple[float, float]:
        assert self._start_value is not None
        start = self._start_value
        if steps < 0:
            return start, 0.0
        size = abs(start) - self._slope * (steps * PERIOD_S)
        if size <= 0.0:
            return 0.0, 0.0
        return math.copysign(size, start), -math.copysign(self._slope, start)
