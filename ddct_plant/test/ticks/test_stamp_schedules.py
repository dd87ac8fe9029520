# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Limits of stamps in real time under arbitrary schedules of true and false messages."""

from collections import deque

import pytest
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, precondition, rule
from tick_machine import INDEX, require_of_schedules

from ddct_plant.base.timebase import PERIOD_NS, stamp_of_step
from ddct_plant.ticks.stamp_limit import TICK_LEAD_NS, StampLimit

TICK, REPLY = '/clock', 'clutch/torque_request'
QUEUE = 10
"""Number of messages that wait for a reader; older ones are lost."""
LEAD_STEPS = TICK_LEAD_NS // PERIOD_NS


class StampMachine(RuleBasedStateMachine):
    """
    A reader whose clock may drift, beside an owner of time that may be late and never early.

    True messages must be accepted whenever they are read. A false stamp of more than the stated
    lead beyond what is due must be refused, and must not make anything else acceptable.
    """

    @initialize(drift_ppm=st.integers(-50, 50), waited_ms=st.sampled_from([0, 30, 20_000]))
    def begin(self, drift_ppm: int, waited_ms: int) -> None:
        self.drift_ppm = drift_ppm
        self.since_start_ns = 0
        self.sent = 0
        self.read_steps = 0
        self.waited_ns = 0
        self.ticks: deque[int] = deque([0], maxlen=QUEUE)
        self.limit = StampLimit([TICK], self.clock_ns, from_t0=True)
        self.read(1)
        self.waited_ns = waited_ms * 1_000_000

    def clock_ns(self) -> int:
        """Return the time of the reader's clock, which starts anywhere."""
        passed = self.since_start_ns * (1_000_000 + self.drift_ppm) // 1_000_000
        return 7_000_000_000 + self.waited_ns + passed

    @property
    def due(self) -> int:
        return self.since_start_ns // PERIOD_NS

    def accepts(self, topic: str, step: int) -> bool:
        return not self.limit.why_refused(topic, stamp_of_step(step))

    @rule(ms=st.sampled_from([1, 4, 10, 10, 10, 70, 600, 3000]), punctual=st.booleans())
    def time_passes(self, ms: int, punctual: bool) -> None:
        """Let the owner send what is due, unless it stands still meanwhile."""
        self.since_start_ns += ms * 1_000_000
        if punctual:
            while self.sent < self.due:
                self.sent += 1
                self.ticks.append(self.sent)

    @rule(count=st.integers(1, QUEUE))
    def read(self, count: int) -> None:
        for _ in range(min(count, len(self.ticks))):
            step = self.ticks.popleft()
            assert self.accepts(TICK, step), 'a true tick'
            assert self.accepts(REPLY, step), 'the reply to a tick that was read'
            self.read_steps = max(self.read_steps, step)

    @rule()
    def go_on_in_time(self) -> None:
        for _ in range(20):
            self.time_passes(10, True)
            self.read(QUEUE)
            assert self.accepts(REPLY, self.sent + 1), 'one period ahead, by another clock'

    @precondition(lambda self: self.ticks)
    @rule(pick=INDEX)
    def lose_a_tick(self, pick: int) -> None:
        del self.ticks[pick % len(self.ticks)]

    @rule(back=st.integers(0, 500))
    def a_late_message_arrives(self, back: int) -> None:
        for topic in (TICK, REPLY):
            assert self.accepts(topic, max(self.read_steps - back, 0))

    @rule(ahead=st.integers(2, 10**8), topic=st.sampled_from([TICK, REPLY]))
    def a_false_stamp_arrives(self, ahead: int, topic: str) -> None:
        # The start counts from the moment at which t_0 was read.
        waited_steps = self.waited_ns // PERIOD_NS
        assert not self.accepts(topic, self.due + waited_steps + LEAD_STEPS + ahead)

    @rule(ahead=st.integers(2, 10**8))
    def a_false_reply_arrives(self, ahead: int) -> None:
        assert not self.accepts(REPLY, self.due + 1 + ahead)


@pytest.mark.slow
def test_true_stamps_are_accepted_and_false_ones_refused_whatever_the_schedule() -> None:
    require_of_schedules(StampMachine, rules=40)
