# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""In real time stamps ahead of the ticks are refused; late ones are accepted."""

import pytest

from ddct_plant.base.timebase import PERIOD_NS, START_NS, stamp_of_step
from ddct_plant.ticks.stamp_limit import TICK_LEAD_NS, StampLimit

TICK, REPLY = '/clock', 'clutch/torque_request'
LATEST_NS = 2_147_483_640 * 10**9
MS = 1_000_000


class Limit:
    """A limit with a hand-driven clock that starts anywhere; refusals by topic and step."""

    def __init__(self, **options):
        self.now = 5_000 * 10**9
        self._limit = StampLimit([TICK], lambda: self.now, **options)

    def takes(self, topic, step):
        return not self._limit.why_refused(topic, stamp_of_step(step))

    def why(self, topic, stamp):
        return self._limit.why_refused(topic, stamp)

    def run_to(self, step):
        """Pass every tick on time."""
        assert self.takes(TICK, 0)
        for each in range(1, step + 1):
            self.now += PERIOD_NS
            assert self.takes(TICK, each)


@pytest.fixture
def limit():
    limit = Limit()
    limit.run_to(100)
    return limit


def test_each_tick_and_its_replies_are_taken(limit):
    for step in range(101, 200):
        limit.now += PERIOD_NS
        for topic in (TICK, 'driveline/joint_states', 'clutch/slip', 'vehicle/twist', REPLY):
            assert limit.takes(topic, step)


@pytest.mark.parametrize('stamp', [0, START_NS - PERIOD_NS, stamp_of_step(101) + 1])
@pytest.mark.parametrize('topic', [TICK, REPLY])
def test_a_stamp_off_the_grid_is_refused_with_its_topic(limit, topic, stamp):
    assert limit.why(topic, stamp).startswith(f'{topic}: stamp {stamp} ns is not on the grid')


def test_a_refusal_shows_a_topic_by_the_name_that_it_is_given():
    limit = Limit(shown=lambda topic: f'side/{topic}')
    for stamp in (stamp_of_step(0) + 1, stamp_of_step(50)):
        assert limit.why(REPLY, stamp).startswith(f'side/{REPLY}: stamp {stamp} ns')


def test_a_reply_may_be_one_step_ahead_of_the_tick_and_no_more(limit):
    assert limit.takes(REPLY, 101)
    assert not limit.takes(REPLY, 102)
    limit.now += PERIOD_NS
    assert limit.takes(REPLY, 102)


def test_a_tick_may_lead_by_the_stated_tolerance_and_no_more(limit):
    lead = TICK_LEAD_NS // PERIOD_NS
    assert not limit.takes(TICK, 101 + lead)
    assert limit.takes(TICK, 100 + lead)


@pytest.mark.parametrize('topic', [TICK, REPLY])
def test_the_latest_stamp_that_a_message_can_hold_is_refused_and_changes_nothing(limit, topic):
    assert 'ahead of what can be due' in limit.why(topic, LATEST_NS)
    assert limit.takes(TICK, 100)
    assert not limit.takes(REPLY, 102)


def test_the_time_for_which_t0_waits_gives_replies_no_lead():
    limit = Limit()
    assert limit.takes(TICK, 0)
    limit.now += 20 * 10**9
    assert limit.takes(REPLY, 1)
    assert not limit.takes(REPLY, 2)
    limit.now += 10**9
    assert limit.takes(TICK, 1)
    assert not limit.takes(REPLY, 3)


def test_before_any_tick_only_replies_to_the_start_are_taken():
    limit = Limit()
    assert limit.takes(REPLY, 0)
    limit.now += 10**9
    assert not limit.takes(REPLY, 50)


QUEUES = {
    'ticks, then replies': lambda ticks, replies: [*ticks, *replies],
    'replies, then ticks': lambda ticks, replies: [*replies, *ticks],
    'in turn': lambda ticks, replies: [
        each for both in zip(ticks, replies, strict=True) for each in both
    ],
    'one tick, then replies': lambda ticks, replies: [ticks[0], *replies, *ticks[1:]],
}


@pytest.mark.parametrize('order', QUEUES.values(), ids=QUEUES)
@pytest.mark.parametrize('queued', [10, 50])
def test_a_node_that_was_stopped_takes_all_that_waits_for_it_and_goes_on(limit, order, queued):
    limit.now += 50 * PERIOD_NS
    ticks, replies = (
        [(topic, step) for step in range(151 - queued, 151)] for topic in (TICK, REPLY)
    )
    for topic, step in order(ticks, replies):
        limit.now += 1000
        assert limit.takes(topic, step), (topic, step)
    limit.now += PERIOD_NS
    assert limit.takes(TICK, 151)
    assert limit.takes(REPLY, 151)
    assert not limit.takes(REPLY, 155)


def test_a_driveline_that_was_stopped_and_catches_up_in_a_burst_is_accepted(limit):
    limit.now += 50 * PERIOD_NS
    for step in range(101, 151):
        assert limit.takes(TICK, step)


def test_a_node_that_starts_late_with_a_full_queue_is_not_left_behind():
    limit = Limit()
    for step in range(500, 510):
        assert limit.takes(TICK, step)
    for step in range(510, 700):
        limit.now += PERIOD_NS
        assert limit.takes(TICK, step)
        assert limit.takes(REPLY, step)


def test_a_true_tick_puts_right_a_false_one_that_came_first():
    limit = Limit()
    assert limit.takes(TICK, 10**8)
    limit.run_to(10)
    assert not limit.takes(TICK, 10**8)
    assert not limit.takes(REPLY, 12)


def test_from_t0_on_nothing_else_can_come_first():
    limit = Limit(from_t0=True)
    assert not limit.takes(TICK, 1)
    limit.run_to(3)
