# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A clutch whose torques may stay away, as the driveline integrates it; independent of ROS."""

from collections.abc import Sequence

from ddct_plant.base.timebase import SUBSTEPS
from ddct_plant.fail_safe.request_watch import FailSafe, FailSafeSettings

Rows = Sequence[list[float]]
"""Rows of 11 torques in N m within a period: transmitted, or kinetic and static capacity."""


class GuardedClutch:
    """
    The torques of one clutch over each period, with a safe state.

    A missing torque is held at its last value. When it is missing for longer than the timeout, it
    runs to zero at the rate of the settings, and later torques are ignored: the safe state.
    """

    def __init__(self, settings: FailSafeSettings) -> None:
        self._fail_safe = FailSafe(settings)
        self._held: list[float] = []

    @property
    def safe(self) -> bool:
        """Whether the torque has timed out and is on its way to zero."""
        return self._fail_safe.stopped

    def torques(self, step: int, received: Rows | None) -> Rows:
        """Return the rows of the period of `step`: those received, held values, or a ramp."""
        if received is not None and not self.safe:
            self._held = [row[-1] for row in received]
            self._fail_safe.request(step)
            self._fail_safe.torque = self._held[0]
            return received
        held = self._held
        if self._fail_safe.tick(step):
            self._held = self._ramped(held)
        return [_line(*ends) for ends in zip(held, self._held, strict=True)]

    def _ramped(self, held: list[float]) -> list[float]:
        """Return the torques in N m one period later on the ramp to zero, in proportion."""
        first = self._fail_safe.next_torque()
        share = first / held[0] if held[0] else 0.0
        return [first, *(max(share * other, first) for other in held[1:])]


def _line(first: float, last: float) -> list[float]:
    """Return the (11,) torques in N m of a period, linear from `first` to `last`."""
    change = (last - first) / SUBSTEPS
    return [*(first + i * change for i in range(SUBSTEPS)), last]
