# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The buffer returns complete ticks; in real time incomplete ones too, but not too soon."""

import pytest

from ddct_bringup.record.tick_buffer import GIVE_UP_AFTER_STEPS, LAG_LIMIT_STEPS, TickBuffer
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import stamp_of_step


class Buffer:
    """Buffer of the topics a and b; its ticks are returned as {step: topics}."""

    def __init__(self, *, lockstep, certain=()):
        self.buffer = TickBuffer(
            ['a', 'b'],
            lambda topic, first, second: first.lower() == second.lower(),
            wait_for_all=lockstep,
            certain=frozenset(certain),
        )

    def offer(self, topic, step, cdr=b'x'):
        ready = self.buffer.offer(topic, stamp_of_step(step), cdr)
        return [(each, ''.join(sorted(tick))) for each, tick in ready]

    def whole(self, step):
        return self.offer('a', step) + self.offer('b', step)

    def drain(self):
        return [(step, ''.join(sorted(tick))) for step, tick in self.buffer.drain()]


@pytest.fixture
def lockstep():
    return Buffer(lockstep=True)


@pytest.fixture
def realtime():
    return Buffer(lockstep=False)


@pytest.mark.parametrize('lock', [True, False])
def test_a_tick_comes_out_once_when_its_last_message_is_here(lock):
    buffer = Buffer(lockstep=lock)
    assert buffer.offer('b', 0) == []
    assert buffer.offer('a', 0) == [(0, 'ab')]
    assert buffer.drain() == []


@pytest.mark.parametrize('lock', [True, False])
def test_ticks_come_out_in_order(lock):
    buffer = Buffer(lockstep=lock)
    assert buffer.offer('a', 0) == []
    assert buffer.whole(1) == []
    assert buffer.whole(2) == []
    assert buffer.offer('b', 0) == [(0, 'ab'), (1, 'ab'), (2, 'ab')]


def test_lock_step_never_gives_an_incomplete_tick_back(lockstep):
    for step in range(LAG_LIMIT_STEPS + 1):
        assert lockstep.offer('a', step) == []
    assert lockstep.drain() == []


def test_lock_step_reports_that_it_missed_the_start(lockstep):
    with pytest.raises(
        DdctError, match=f'a: step {LAG_LIMIT_STEPS + 1} came where step 0 was due'
    ):
        lockstep.offer('a', LAG_LIMIT_STEPS + 1)


def test_real_time_waits_for_a_late_message_before_it_gives_its_tick_up(realtime):
    assert realtime.offer('a', 0) == []
    for step in range(1, GIVE_UP_AFTER_STEPS):
        assert realtime.whole(step) == []
    whole = [(step, 'ab') for step in range(1, GIVE_UP_AFTER_STEPS)]
    assert realtime.offer('b', 0) == [(0, 'ab'), *whole]
    assert realtime.buffer.dropped == 0


def test_real_time_gives_a_tick_up_when_one_so_much_later_begins(realtime):
    realtime.offer('a', 0)
    for step in range(1, GIVE_UP_AFTER_STEPS):
        realtime.whole(step)
    whole = [(step, 'ab') for step in range(1, GIVE_UP_AFTER_STEPS)]
    assert realtime.offer('a', GIVE_UP_AFTER_STEPS) == [(0, 'a'), *whole]
    assert realtime.offer('b', 0) == []
    assert realtime.buffer.dropped == 1


def test_real_time_waits_longer_for_what_the_tick_itself_consists_of():
    """A reply may be missing in a recording, the message `a` of the tick may not."""
    realtime = Buffer(lockstep=False, certain=('a',))
    realtime.offer('b', 0)
    realtime.offer('a', 1)
    for step in range(2, LAG_LIMIT_STEPS):
        assert realtime.whole(step) == []
    assert realtime.offer('a', 0)[:3] == [(0, 'ab'), (1, 'a'), (2, 'ab')]
    assert realtime.buffer.dropped == 0


@pytest.mark.parametrize('begun', [True, False])
def test_real_time_goes_on_when_what_the_tick_itself_consists_of_is_lost(begun):
    realtime = Buffer(lockstep=False, certain=('a',))
    if begun:
        realtime.offer('b', 0)
    for step in range(1, LAG_LIMIT_STEPS):
        assert realtime.whole(step) == []
    first = [(0, 'b')] if begun else []
    whole = [(step, 'ab') for step in range(1, LAG_LIMIT_STEPS)]
    assert realtime.offer('a', LAG_LIMIT_STEPS) == [*first, *whole]
    assert realtime.offer('a', 0) == []
    assert realtime.buffer.dropped == 1


def test_a_step_of_which_nothing_came_is_passed_over(realtime):
    realtime.whole(0)
    for step in range(2, 1 + GIVE_UP_AFTER_STEPS):
        assert realtime.whole(step) == []
    ready = realtime.offer('a', 1 + GIVE_UP_AFTER_STEPS)
    assert ready == [(step, 'ab') for step in range(2, 1 + GIVE_UP_AFTER_STEPS)]


def test_a_late_message_of_a_step_that_was_passed_over_is_dropped_and_no_sign_of_two_nodes(
    realtime,
):
    realtime.offer('a', 0, b'one')
    assert realtime.offer('b', 1 + GIVE_UP_AFTER_STEPS, b'far') == [(0, 'a')]
    assert realtime.offer('a', 1, b'two') == []
    assert realtime.buffer.dropped == 1


def test_how_far_a_stamp_lies_ahead_costs_no_time(realtime):
    realtime.whole(0)
    realtime.offer('a', 1)
    assert realtime.offer('a', 10**14) == [(1, 'a')]
    assert realtime.drain() == [(10**14, 'a')]


def test_what_is_left_comes_out_at_the_end_in_real_time_only(realtime, lockstep):
    for buffer in (realtime, lockstep):
        buffer.offer('a', 0)
        buffer.offer('b', 3)
    assert realtime.drain() == [(0, 'a'), (3, 'b')]
    assert lockstep.drain() == []


@pytest.mark.parametrize('complete', [False, True])
def test_a_repeated_message_is_dropped_and_a_different_one_is_an_error(realtime, complete):
    realtime.offer('a', 0, b'one')
    if complete:
        realtime.offer('b', 0)
    assert realtime.offer('a', 0, b'one') == []
    assert realtime.offer('a', 0, b'ONE') == [], 'the same but for padding'
    with pytest.raises(DdctError, match='a carries two different messages for stamp 1000000000'):
        realtime.offer('a', 0, b'two')


def test_a_stamp_off_the_grid_is_an_error_with_its_topic(lockstep):
    with pytest.raises(DdctError, match='a: stamp 1000000001 ns is not on the grid'):
        lockstep.buffer.offer('a', 1_000_000_001, b'')


class UndecidedBuffer(Buffer):
    """Buffer of the topics a, b and c; the run may lack c."""

    def __init__(self, *, lockstep):
        super().__init__(lockstep=lockstep)
        self.buffer.topics = ['a', 'b', 'c']
        self.buffer.undecided = frozenset('c')

    def decide(self, present):
        return [(step, ''.join(sorted(tick))) for step, tick in self.buffer.decide(present)]


@pytest.mark.parametrize('lock', [True, False])
def test_ticks_wait_for_an_undecided_topic_only_until_the_run_is_known_to_lack_it(lock):
    buffer = UndecidedBuffer(lockstep=lock)
    assert buffer.whole(0) == []
    assert buffer.decide('') == [(0, 'ab')]
    assert buffer.whole(1) == [(1, 'ab')]
    assert buffer.offer('c', 2) == [], 'whoever publishes it all the same'
    assert buffer.whole(2) == [(2, 'ab')]


@pytest.mark.parametrize('lock', [True, False])
def test_an_undecided_topic_that_the_run_has_belongs_to_each_tick(lock):
    buffer = UndecidedBuffer(lockstep=lock)
    assert buffer.whole(0) == []
    assert buffer.decide('c') == []
    assert buffer.offer('c', 0) == [(0, 'abc')]
    assert buffer.decide('') == [], 'decided once'
    assert buffer.whole(1) == []


def test_a_topic_that_the_run_lacks_is_in_no_tick_whenever_its_message_came():
    buffer = UndecidedBuffer(lockstep=True)
    assert buffer.offer('c', 0) == []
    assert buffer.offer('a', 0) == []
    assert buffer.decide('') == []
    assert buffer.offer('b', 0) == [(0, 'ab')]


def test_ticks_without_an_undecided_topic_are_no_sign_of_a_missed_start():
    buffer = UndecidedBuffer(lockstep=True)
    last = LAG_LIMIT_STEPS + 5
    for step in range(last + 1):
        assert buffer.whole(step) == []
    assert buffer.decide('') == [(step, 'ab') for step in range(last + 1)]


def test_a_recorder_that_missed_the_start_of_a_real_time_run_has_no_tick(realtime):
    for step in range(GIVE_UP_AFTER_STEPS + 1, 3 * LAG_LIMIT_STEPS):
        assert realtime.whole(step) == []
    assert realtime.drain() == []
    assert realtime.buffer.dropped == 2 * (3 * LAG_LIMIT_STEPS - GIVE_UP_AFTER_STEPS - 1)
