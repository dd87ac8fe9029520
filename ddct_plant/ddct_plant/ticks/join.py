# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Join the inputs of a node on their stamp; does not depend on ROS."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import Enum, auto

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import step_of_stamp

MOST_WAITING = 10
"""Largest number of incomplete stamps: the depth of a topic's queue."""


class JoinResult(Enum):
    """Result of one arrived input."""

    WAIT = auto()
    """Other inputs of this stamp are still missing."""
    COMPLETE = auto()
    """Every input of a new stamp is here: compute the reply."""
    REPEAT = auto()
    """The owner of time repeats its tick: publish the last reply once more."""
    BEGUN_ANEW = auto()
    """The owner of time begins a run after a later step of another: publish the last reply, whose
    stamp shows that this node has run already."""
    IGNORE = auto()
    """The input was already used, or is older than the last complete stamp."""


@dataclass
class StampJoin:
    """
    Collect one message per input topic until all carry the same stamp.

    The first topic of `topics` is the trigger: only its repetition requests the last reply, so one
    re-sent tick makes one repeated reply, however many inputs a node has. A gap between the last
    complete stamp and the next one is an error in lock-step, and so are more than `MOST_WAITING`
    incomplete stamps. With `allow_gaps` (real time) a gap is skipped, and the oldest incomplete
    stamp is dropped.
    """

    topics: Sequence[str]
    """Names of the input topics, the trigger first."""
    allow_gaps: bool = False
    """Whether steps may be missing between two complete stamps, as in real time."""
    shown: Callable[[str], str] = str
    """Function that returns the name of a topic in errors."""
    last_step: int = -1
    """Step of the last complete stamp, -1 before the first one."""
    _waiting: dict[int, dict[str, object]] = field(default_factory=dict)

    def offer(self, topic: str, stamp_ns: int, message: object) -> JoinResult:
        """Add one message; raise DdctError for a stamp off the grid or, in lock-step, a gap."""
        try:
            step = step_of_stamp(stamp_ns)
        except DdctError as error:
            name = self.shown(topic)
            raise DdctError(f'{name}: {error}', key=name) from error
        if step <= self.last_step:
            if topic != self.topics[0]:
                return JoinResult.IGNORE
            if step == self.last_step:
                return JoinResult.REPEAT
            return JoinResult.IGNORE if step else JoinResult.BEGUN_ANEW
        inputs = self._waiting.get(step)
        if inputs is None:
            self._make_room(topic, step)
            inputs = self._waiting[step] = {}
        inputs[topic] = message
        if len(inputs) < len(self.topics):
            return JoinResult.WAIT
        self._accept(step)
        return JoinResult.COMPLETE

    def take(self) -> tuple[int, dict[str, object]]:
        """Return the last complete step and its messages by topic, and remove them."""
        return self.last_step, self._waiting.pop(self.last_step)

    def _make_room(self, topic: str, step: int) -> None:
        if len(self._waiting) < MOST_WAITING:
            return
        if not self.allow_gaps:
            name = self.shown(topic)
            raise DdctError(
                f'{name}: step {step} came while {len(self._waiting)} others wait for the rest '
                f'of their inputs and step {self.last_step + 1} is due: check what publishes '
                f'{" and ".join(map(self.shown, self.topics))}',
                key=name,
            )
        del self._waiting[min(self._waiting)]

    def _accept(self, step: int) -> None:
        expected = self.last_step + 1
        if step != expected and not self.allow_gaps:
            name = self.shown(self.topics[0])
            raise DdctError(
                f'{name}: step {step} came where step {expected} was due: this node missed a part '
                'of the run, start the graph again with every node in it',
                key=name,
            )
        self.last_step = step
        if len(self._waiting) > 1:
            for older in [waiting for waiting in self._waiting if waiting < step]:
                del self._waiting[older]
