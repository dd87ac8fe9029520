# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What the on-coming clutch of a shift takes over, and the adapter for its message."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from ddct_plant.base.errors import MOST_SIGNAL, require_number, require_signal
from ddct_plant.signals.message_kind import ClassOf, MessageKind

LEAST_DEVIATION = -0.9
"""Lowest deviation of the wear gain that a node accepts: a request is divided by 1 plus it."""


class OnComingShare(NamedTuple):
    """Share of the on-coming clutch in C_fOL, and what is known of what that clutch carries."""

    share: float
    """Share of C_fOL that it carries, 0 to 1; feedback starts with 1."""
    wear_deviation: float = 0.0
    """Estimate of its wear gain less 1; 0 where nothing is known."""
    torque_offset: float = 0.0
    """Estimate in N m of what it carries beyond wear gain times request."""

    def request(self, torque: float) -> float:
        """Return the request in N m with which the clutch carries a torque in N m."""
        return (torque - self.torque_offset) / (1.0 + self.wear_deviation)


WHOLE = OnComingShare(1.0)
"""That of a clutch that carries everything, of which nothing is known."""


@dataclass(frozen=True)
class ShareVector(MessageKind):
    """Adapter for a Vector3Stamped: share, deviation of the wear gain, offset in N m."""

    def _filler(self, message: Any, class_of: ClassOf) -> Callable[..., None]:
        vector = message.vector

        def fill(share: float, wear_deviation: float, torque_offset: float) -> None:
            vector.x, vector.y, vector.z = share, wear_deviation, torque_offset

        return fill

    def values(self, message: Any) -> tuple[float, float, float]:
        """Return the three numbers."""
        vector = message.vector
        return vector.x, vector.y, vector.z

    def read(self, topic: str, message: Any) -> OnComingShare:
        """Return the share; raise DdctError unless all is finite and within its bounds."""
        share, deviation, offset = self.values(message)
        return OnComingShare(
            require_number(topic, share, at_least=0.0, at_most=1.0),
            require_number(topic, deviation, at_least=LEAST_DEVIATION, at_most=MOST_SIGNAL),
            require_signal(topic, offset),
        )
