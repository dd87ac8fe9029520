# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""In real time replies far ahead of the ticks are refused; late ones are accepted."""

import pytest

from ddct_plant.base.timebase import PERIOD_NS, START_NS, stamp_of_step
from ddct_plant.ticks.join import MOST_WAITING
from ddct_plant.ticks.reply_limit import ReplyLimit

TICK, REPLY = '/clock', 'clutch/torque_request'
LATEST_NS = 2_147_483_640 * 10**9


@pytest.fixture
def limit():
    return ReplyLimit([TICK], lambda topic: f'side/{topic}')


def takes(limit, topic, step):
    return not limit.why_refused(topic, stamp_of_step(step))


@pytest.mark.parametrize('stamp', [0, START_NS - PERIOD_NS, stamp_of_step(101) + 1])
@pytest.mark.parametrize('topic', [TICK, REPLY])
def test_a_stamp_off_the_grid_is_refused_with_its_topic(limit, topic, stamp):
    assert limit.why_refused(topic, stamp).startswith(
        f'side/{topic}: stamp {stamp} ns is not on the grid'
    )
    assert limit.newest is None


def test_before_any_tick_only_replies_to_the_start_are_taken(limit):
    assert takes(limit, REPLY, 0) and takes(limit, REPLY, MOST_WAITING)
    assert not takes(limit, REPLY, MOST_WAITING + 1)


def test_a_reply_may_be_read_as_long_before_its_tick_as_a_queue_holds_ticks(limit):
    """So a node that was stopped takes all that waits for it, in whatever order."""
    assert takes(limit, TICK, 100)
    assert takes(limit, REPLY, 100 + MOST_WAITING)
    assert 'is 11 steps ahead of the ticks' in limit.why_refused(REPLY, stamp_of_step(111))
    assert takes(limit, TICK, 101) and takes(limit, REPLY, 111)


def test_late_replies_and_ticks_after_a_pause_are_taken(limit):
    for step in (0, 1, 500, 501):
        assert takes(limit, TICK, step)
        assert limit.newest == step
    assert takes(limit, REPLY, 3)


def test_an_old_tick_that_comes_again_refuses_no_reply(limit):
    assert takes(limit, TICK, 100) and takes(limit, TICK, 70)
    assert limit.newest == 100 and takes(limit, REPLY, 101)


def test_the_latest_stamp_that_a_message_can_hold_is_refused_and_changes_nothing(limit):
    assert takes(limit, TICK, 100)
    assert 'ahead of the ticks' in limit.why_refused(REPLY, LATEST_NS)
    assert takes(limit, REPLY, 101) and not takes(limit, REPLY, 111)
