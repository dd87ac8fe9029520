# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Buffer the messages of each tick until the tick is complete; independent of ROS."""

from collections.abc import Callable, Container, Sequence
from dataclasses import dataclass, field

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import stamp_of_step, step_of_stamp

GIVE_UP_AFTER_STEPS = 10
"""Number of steps after which, in real time, a tick is written without a reply that it lacks."""

LAG_LIMIT_STEPS = 100
"""
Number of steps after which a message that certainly comes is lost: in lock-step each message of a
tick, in real time those that the tick itself consists of.
"""

Tick = dict[str, bytes]
"""Serialised messages of one stamp, by topic."""


class TwoMessagesError(DdctError):
    """Two nodes publish one topic."""


@dataclass
class TickBuffer:
    """
    Collect serialised messages by stamp and return complete ticks in order.

    Repeated messages are dropped; two different ones for one topic and stamp mean that two
    nodes publish it, which is an error.
    """

    topics: Sequence[str]
    """Topics of a complete tick."""
    same: Callable[[str, bytes, bytes], bool]
    """Function that returns whether two serialised messages of a topic are equal."""
    wait_for_all: bool = True
    """Whether only complete ticks are returned, as in lock-step."""
    certain: frozenset[str] = frozenset()
    """Topics of the tick itself, which come in real time too: a bag without one is refused."""
    undecided: frozenset[str] = frozenset()
    """Topics that the run may lack; complete ticks have them until `decide`."""
    dropped: int = 0
    """Number of messages that arrived too late; real time only."""
    _next_step: int = 0
    _pending: dict[int, Tick] = field(default_factory=dict)
    _last: tuple[int, Tick] = field(default_factory=lambda: (-1, {}))

    def offer(self, topic: str, stamp_ns: int, cdr: bytes) -> list[tuple[int, Tick]]:
        """Add one message; return the (step, tick) pairs that can now be written, in order."""
        try:
            step = step_of_stamp(stamp_ns)
        except DdctError as error:
            raise DdctError(f'{topic}: {error}', key=topic) from error
        if topic not in self.topics:
            return []
        begun = self.wait_for_all or self._next_step or self._pending
        if not begun and step > GIVE_UP_AFTER_STEPS:
            self.dropped += 1  # the recorder missed the start
            return []
        if step < self._next_step:
            self._check_repeat(step, topic, cdr)
            return []
        lags = self.wait_for_all and step > self._next_step + LAG_LIMIT_STEPS
        if lags and not self.undecided:
            raise DdctError(
                f'{topic}: step {step} came where step {self._next_step} was due: this recorder '
                'missed a part of the run, start it first or set require_recorder on driveline',
                key=topic,
            )
        tick = self._pending.setdefault(step, {})
        if topic in tick:
            self._require_same(topic, tick[topic], cdr, step)
            return []
        tick[topic] = cdr
        if self.wait_for_all and len(tick) < len(self.topics):
            return []
        return self._ready()

    def decide(self, present: Container[str]) -> list[tuple[int, Tick]]:
        """
        Drop those undecided topics that the run lacks; return the ticks that are complete now.

        `present` has the names of the topics that the run has.
        """
        lacking = {topic for topic in self.undecided if topic not in present}
        self.undecided = frozenset()
        if not lacking:
            return []
        self.topics = [topic for topic in self.topics if topic not in lacking]
        for tick in self._pending.values():
            for topic in lacking:
                tick.pop(topic, None)
        return self._ready()

    @property
    def last(self) -> Tick:
        """Messages of the last tick that was returned; empty before the first."""
        return self._last[1]

    def missing(self) -> list[str]:
        """Return the topics without a message of the step that is due, if it has any message."""
        tick = self._pending.get(self._next_step, {})
        return [topic for topic in self.topics if tick and topic not in tick]

    def drain(self) -> list[tuple[int, Tick]]:
        """Return the remaining ticks when recording ends; only real time keeps incomplete ones."""
        return [] if self.wait_for_all else self._ready(over=True)

    def _ready(self, *, over: bool = False) -> list[tuple[int, Tick]]:
        """Return the ticks that can be written now; all of them when real time is over."""
        ready = []
        newest = max(self._pending, default=0) + (LAG_LIMIT_STEPS if over else 0)
        while self._pending:
            step = min(self._pending)
            if step > self._next_step and not self._skip_to(step, newest):
                break
            tick = self._pending[step]
            if len(tick) < len(self.topics) and step > self._give_up_step(tick, newest):
                break
            ready.append((step, self._pending.pop(step)))
            self._last = (step, tick)
            self._next_step = step + 1
        return ready

    def _give_up_step(self, tick: Tick, newest: int) -> int:
        """Return the last step that is not waited for if it has no more than `tick`."""
        if self.wait_for_all:
            return -1
        lost = self.certain - tick.keys()
        return newest - (LAG_LIMIT_STEPS if lost else GIVE_UP_AFTER_STEPS)

    def _skip_to(self, step: int, newest: int) -> bool:
        """Drop steps without a message, at most up to `step`; return whether all are dropped."""
        self._next_step = max(self._next_step, min(step, self._give_up_step({}, newest) + 1))
        return self._next_step == step

    def _check_repeat(self, step: int, topic: str, cdr: bytes) -> None:
        # The steps before the next one may have been skipped, and are not the last tick then.
        last_step, last = self._last
        if step != last_step or topic not in last:
            self.dropped += not self.wait_for_all
            return
        self._require_same(topic, last[topic], cdr, step)

    def _require_same(self, topic: str, first: bytes, second: bytes, step: int) -> None:
        if first != second and not self.same(topic, first, second):
            raise TwoMessagesError(
                f'{topic} carries two different messages for stamp {stamp_of_step(step)} ns: stop '
                'the second node that publishes it, or use another ROS_DOMAIN_ID',
                key=topic,
            )
