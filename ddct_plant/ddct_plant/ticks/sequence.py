# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Detect two publishers of a topic by the sequence numbers of messages; independent of ROS."""

PROOF = 3
"""Returns to an earlier sequence that prove two publishers: one may be chance after losses."""


class SequenceWatch:
    """
    Detect two live publishers of one topic; each publisher numbers its messages in sequence.

    A restarted publisher begins a new sequence, and the old one ends. The sequences of two live
    publishers alternate, each going on from its own last number.
    """

    def __init__(self) -> None:
        self._last: int | None = None
        self._earlier: set[int] = set()
        self._returns = 0

    @property
    def two_alive(self) -> bool:
        """Whether the sequences of two publishers alternate."""
        return self._returns >= PROOF

    def note(self, number: int) -> None:
        """Note the sequence number of the next message."""
        if self._last is not None and number != self._last + 1:
            if number - 1 in self._earlier:
                self._earlier.remove(number - 1)
                self._returns += 1
            self._earlier.add(self._last)
        self._last = number
