"""Join the inputs of a node on their stamp; knows nothing of ROS."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum, auto
from typing import Any

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import step_of_stamp

MOST_WAITING = 10
"""Stamps that may wait for inputs at a time, as many messages as a topic's queue holds."""


class Verdict(Enum):
    """What the arrival of one input means."""

    WAIT = auto()
    """Other inputs of this stamp are still missing."""
    COMPLETE = auto()
    """Every input of a new stamp is here: compute the reply."""
    REPEAT = auto()
    """The owner of time asks again: publish the last reply once more."""
    IGNORE = auto()
    """An input that was already used, or older than the last stamp."""


@dataclass
class StampJoin:
    """
    Collect one message per input topic until all carry the same stamp.

    The first topic of `topics` is the trigger: only its repetition asks for the last reply, so one
    re-sent tick makes one repeated reply, however many inputs a node has. A gap between the last
    stamp and a complete one is an error in lock-step, and so are more than `MOST_WAITING` stamps
    that wait. With `allow_gaps` (real time) the gap is passed over, and the oldest given up.
    """

    topics: Sequence[str]
    allow_gaps: bool = False
    last_step: int = -1
    """Step of the last complete join, -1 before there is one."""
    _waiting: dict[int, dict[str, Any]] = field(default_factory=dict)

    def offer(self, topic: str, stamp_ns: int, message: Any) -> Verdict:
        """Take one message; raise DdctError for a stamp off the grid or, in lock-step, a gap."""
        try:
            step = step_of_stamp(stamp_ns)
        except DdctError as error:
            raise DdctError(f'{topic}: {error}') from error
        if step <= self.last_step:
            again = step == self.last_step and topic == self.topics[0]
            return Verdict.REPEAT if again else Verdict.IGNORE
        inputs = self._waiting.get(step)
        if inputs is None:
            self._make_room(topic, step)
            inputs = self._waiting[step] = {}
        inputs[topic] = message
        if len(inputs) < len(self.topics):
            return Verdict.WAIT
        self._accept(step)
        return Verdict.COMPLETE

    def take(self) -> tuple[int, dict[str, Any]]:
        """Return the step of the last complete join and its messages by topic, once."""
        return self.last_step, self._waiting.pop(self.last_step)

    def _make_room(self, topic: str, step: int) -> None:
        if len(self._waiting) < MOST_WAITING:
            return
        if not self.allow_gaps:
            raise DdctError(
                f'{topic}: step {step} came while {len(self._waiting)} others wait for the rest '
                f'of their inputs and step {self.last_step + 1} is due: check what publishes '
                f'{" and ".join(self.topics)}'
            )
        del self._waiting[min(self._waiting)]

    def _accept(self, step: int) -> None:
        expected = self.last_step + 1
        if step != expected and not self.allow_gaps:
            raise DdctError(
                f'{self.topics[0]}: step {step} came where step {expected} was due: this node '
                'missed a part of the run, start the graph again with every node in it'
            )
        self.last_step = step
        if len(self._waiting) > 1:
            for older in [waiting for waiting in self._waiting if waiting < step]:
                del self._waiting[older]
