# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Slip-speed references with preview; that of most runs follows w_d, or stored values, first."""

import math
import sys
from abc import ABC, abstractmethod
from collections.abc import Sequence

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import PERIOD_S
from ddct_reference.descent import Descent

NEVER = sys.maxsize
"""Start step of a reference that does not start until the share of a handover is 1."""


class SlipReference(ABC):
    """
    Slip speed that the controller shall follow, step by step, with its preview.

    It starts at a given step; in a gear shift with the first period in which the on-coming clutch
    carries the whole of C_fOL.
    """

    follows_shaft = False
    """Whether `update` needs the shaft's speed."""

    def __init__(self, start_step: int, preview_steps: int) -> None:
        """Take the step of the start, and the number of steps ahead."""
        self.start_step = start_step
        """Step at which the reference starts towards zero; NEVER while a handover goes on."""
        self.preview_steps = preview_steps
        """Number P of steps ahead."""

    def update(
        self, step: int, slip_speed: float, shaft_speed: float = math.nan, share: float = 1.0
    ) -> tuple[list[float], list[float]]:
        """
        Return the reference in rad/s and its rate in rad/s^2 at steps k, k + 1, ..., k + P.

        `slip_speed` is w_d in rad/s at step k, `shaft_speed` w_p, which only a reference that
        `follows_shaft` uses. The rate is that of the coming period. `share` is that of C_fOL on
        the on-coming clutch of a shift: below 1 the reference equals w_d. Raise DdctError where
        it falls below 1 again.
        """
        if share < 1.0:
            if self.start_step != NEVER:
                raise DdctError(
                    f'handover share {share:g} at step {step}, after the share 1 of step '
                    f'{self.start_step}: a handover keeps the share 1, mend its code'
                )
        elif self.start_step == NEVER:
            self.start_step = step
        return self._ahead(step, slip_speed, shaft_speed)

    @abstractmethod
    def _ahead(
        self, step: int, slip_speed: float, shaft_speed: float
    ) -> tuple[list[float], list[float]]:
        """Return the reference and its rate at steps k, k + 1, ..., k + P."""


class DescendingReference(SlipReference):
    """
    The slip speed, or stored values, until control start, then a `Descent` to zero.

    Without stored values it is CRF's reference generator, that of the detailed architecture
    (Section 1.4.1). It equals w_d until control starts, and from then on does not depend on it any
    more. Until then the preview assumes that the descent begins from the present slip speed.

    With stored values it is a function of time (Section 1.6): the slip speed of the run does not
    change it, so its preview is exact everywhere.
    """

    def __init__(
        self,
        descent: Descent,
        control_start_step: int,
        preview_steps: int = 0,
        stored: Sequence[float] = (),
    ) -> None:
        """Take the number of preview steps; `stored` is in rad/s at steps 0 to control start."""
        super().__init__(control_start_step, preview_steps)
        self._descent = descent
        self._stored = stored
        self._start_value = stored[-1] if stored else math.nan
        """Value in rad/s at control start, or the present one before it."""

    def _ahead(
        self, step: int, slip_speed: float, shaft_speed: float
    ) -> tuple[list[float], list[float]]:
        """Return the reference and its rate at steps k, k + 1, ..., k + P."""
        follows = step <= self.start_step or math.isnan(self._start_value)
        if follows and not self._stored:
            self._start_value = slip_speed
        points = [self._point(step + ahead) for ahead in range(self.preview_steps + 1)]
        return [speed for speed, _ in points], [rate for _, rate in points]

    def _point(self, step: int) -> tuple[float, float]:
        if step >= self.start_step:
            time_s = (step - self.start_step) * PERIOD_S
            return self._descent.at(self._start_value, time_s)
        if not self._stored:
            return self._start_value, 0.0
        value = self._stored[step]
        return value, (self._stored[step + 1] - value) / PERIOD_S
