# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Warnings of a node in real time, which must not cost its loop any time."""

import inspect
from collections.abc import Callable

from rclpy.node import Node

PERIOD_S = 1.0
"""Shortest time in s from one warning to the next."""


def find_sources() -> None:
    """
    Look up the source files of all modules, as the first message to a log does.

    It takes 20 ms, and a fork has what its parent has found.
    """
    inspect.getmodule(find_sources.__code__)


class RareWarnings:
    """
    Warnings of which at most one a second is logged.

    The throttle of rclpy looks for the source file of its caller at every call, also of one that
    it drops, which takes 0.2 ms.
    """

    def __init__(self, node: Node, clock: Callable[[], float]) -> None:
        """Warn for a node; `clock` is a steady clock in s."""
        self._node = node
        self._clock = clock
        self._next_at = clock()

    def warn(self, text: str) -> None:
        """Log a warning, unless one was logged within `PERIOD_S`."""
        now = self._clock()
        if now >= self._next_at:
            self._next_at = now + PERIOD_S
            self._node.get_logger().warning(text)
