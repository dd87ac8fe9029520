"""Tell from their sequence numbers that messages have two publishers; knows nothing of ROS."""

PROOF = 3
"""How often an earlier publisher must be heard again: once may be chance after lost messages."""


class SequenceWatch:
    """
    Hear the numbers under which the messages of one topic were sent, each publisher counting up.

    A publisher that is started again begins anew and is heard once; two that are alive are heard
    in turns, each going on from its own last number.
    """

    def __init__(self) -> None:
        self._last: int | None = None
        self._earlier: set[int] = set()
        self._returns = 0

    @property
    def two_alive(self) -> bool:
        """Whether two publishers have been heard in turns."""
        return self._returns >= PROOF

    def hear(self, number: int) -> None:
        """Take the number of the next message."""
        if self._last is not None and number != self._last + 1:
            if number - 1 in self._earlier:
                self._earlier.remove(number - 1)
                self._returns += 1
            self._earlier.add(self._last)
        self._last = number
