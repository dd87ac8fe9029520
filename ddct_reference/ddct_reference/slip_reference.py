"""Slip-speed references with preview: one that follows the slip first, one stored over time."""

import math
from abc import ABC, abstractmethod
from collections.abc import Sequence

from ddct_plant.base.timebase import PERIOD_S
from ddct_reference.descent import Descent


class SlipReference(ABC):
    """The slip speed that the controller shall follow, step by step, and what comes next."""

    follows_shaft = False
    """Whether `update` needs the shaft's speed."""

    @abstractmethod
    def update(
        self, step: int, slip_speed: float, shaft_speed: float = math.nan
    ) -> tuple[list[float], list[float]]:
        """
        Return the reference in rad/s and its rate in rad/s^2 at steps k, k + 1, ..., k + P.

        `slip_speed` is w_d in rad/s at step k, `shaft_speed` w_p, which only a reference that
        `follows_shaft` looks at. The rate is that of the coming period.
        """


class DescendingReference(SlipReference):
    """A reference that runs to zero as a `Descent` does."""

    def __init__(self, descent: Descent, control_start_step: int, preview_steps: int) -> None:
        """Take how it runs to zero from `control_start_step` on, and the steps to look ahead."""
        self._descent = descent
        self._start_step = control_start_step
        self._preview_steps = preview_steps

    def update(
        self, step: int, slip_speed: float, shaft_speed: float = math.nan
    ) -> tuple[list[float], list[float]]:
        """Return the reference and its rate at steps k, k + 1, ..., k + P."""
        start_value = self._start_value(step, slip_speed)
        points = [
            self._point(step + ahead, start_value) for ahead in range(self._preview_steps + 1)
        ]
        speeds, rates = zip(*points, strict=True)
        return list(speeds), list(rates)

    def _point(self, step: int, start_value: float) -> tuple[float, float]:
        since_start = step - self._start_step
        if since_start < 0:
            return self._before_start(step, start_value)
        return self._descent.at(start_value, since_start * PERIOD_S)

    @abstractmethod
    def _start_value(self, step: int, slip_speed: float) -> float:
        """Return the value in rad/s at control start, as it is known at step k."""

    @abstractmethod
    def _before_start(self, step: int, start_value: float) -> tuple[float, float]:
        """Return the value and its rate at a step before control starts."""


class FollowingReference(DescendingReference):
    """
    CRF's reference generator, that of the detailed architecture (Section 1.4.1).

    The output equals w_d until control starts, and from then on does not depend on it any more.
    Until then the preview assumes that the descent begins from the slip speed of now.
    """

    def __init__(self, descent: Descent, control_start_step: int, preview_steps: int = 0) -> None:
        """Start without having seen any slip speed."""
        super().__init__(descent, control_start_step, preview_steps)
        self._followed: float | None = None

    def _start_value(self, step: int, slip_speed: float) -> float:
        if step <= self._start_step or self._followed is None:
            self._followed = slip_speed
        return self._followed

    def _before_start(self, step: int, start_value: float) -> tuple[float, float]:
        return start_value, 0.0


class StoredReference(DescendingReference):
    """
    A function of time: stored values until control starts, then the descent (Section 1.6).

    The slip speed of the run does not change it, so its preview is exact everywhere.
    """

    def __init__(self, descent: Descent, stored: Sequence[float], preview_steps: int = 0) -> None:
        """Take the values in rad/s at steps 0, 1, ..., up to and with the first controlled one."""
        super().__init__(descent, len(stored) - 1, preview_steps)
        self._stored = stored

    def _start_value(self, step: int, slip_speed: float) -> float:
        return self._stored[-1]

    def _before_start(self, step: int, start_value: float) -> tuple[float, float]:
        value = self._stored[step]
        return value, (self._stored[step + 1] - value) / PERIOD_S
