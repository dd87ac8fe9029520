"""What the owner of time waits for before it takes a step; knows nothing of ROS."""

from collections.abc import Sequence
from typing import Any

from ddct_plant.base.timebase import stamp_of_step


class TickBarrier:
    """
    The replies to one tick, by topic.

    Only replies stamped exactly t_k count; everything else is ignored and counted, so that old
    data never enters a step.
    """

    def __init__(self) -> None:
        self._topics: tuple[str, ...] = ()
        self._stamp_ns = stamp_of_step(0)
        self._replies: dict[str, Any] = {}
        self.ignored = 0
        """Replies to another tick, and repeated ones."""
        self.late = 0
        """Replies to a tick that was already over."""

    def open(self, step: int, topics: Sequence[str]) -> None:
        """Forget the replies of the last tick and wait for those of `topics` to `step`."""
        self._topics = tuple(topics)
        self._stamp_ns = stamp_of_step(step)
        self._replies = {}

    def offer(self, topic: str, stamp_ns: int, reply: Any) -> bool:
        """Take a reply; return whether it was the one that completed the tick."""
        if stamp_ns != self._stamp_ns or topic not in self._topics or topic in self._replies:
            self.ignored += 1
            self.late += stamp_ns < self._stamp_ns
            return False
        self._replies[topic] = reply
        return len(self._replies) == len(self._topics)

    def get(self, topic: str) -> Any:
        """Return the reply on `topic`, or None while it is missing."""
        return self._replies.get(topic)

    def missing(self) -> list[str]:
        """Return the topics that have not answered, in the order they were given."""
        return [topic for topic in self._topics if topic not in self._replies]
