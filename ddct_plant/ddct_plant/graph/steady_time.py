# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The time by which a node waits: a steady clock and its timers."""

import time
from collections.abc import Callable
from typing import Protocol

from rclpy.clock import Clock, ClockType
from rclpy.node import Node


class Cancellable(Protocol):
    """A timer."""

    def cancel(self) -> None:
        """Call the function of the timer no more."""


class SteadyTime:
    """
    The steady clock of the machine; a test gives a node one that it advances by hand instead.

    Timers do not follow the ROS clock, which would wait for simulated time. Each node has a clock
    of its own: rclpy prints a warning on standard output about one that has the timers of a whole
    graph.
    """

    def __init__(self) -> None:
        self._clock = Clock(clock_type=ClockType.STEADY_TIME)

    def monotonic_ns(self) -> int:
        """Return the time in ns since a fixed instant."""
        return time.monotonic_ns()

    def monotonic(self) -> float:
        """Return the time in s since that instant."""
        return 1e-9 * self.monotonic_ns()

    def every(self, node: Node, period_s: float, callback: Callable[[], object]) -> Cancellable:
        """Let the executor of `node` call a function every `period_s`, the first time after it."""
        return node.create_timer(period_s, callback, clock=self._clock)
