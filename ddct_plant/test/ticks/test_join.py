# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Inputs are joined on their stamp and answered once."""

import pytest
from refusals import refused

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import stamp_of_step
from ddct_plant.ticks.join import MOST_WAITING, JoinResult, StampJoin


def offer(join: StampJoin, topic: str, step: int) -> JoinResult:
    return join.offer(topic, stamp_of_step(step), f'{topic}{step}')


def test_a_stamp_is_complete_when_every_input_has_it():
    join = StampJoin(['a', 'b'])
    assert offer(join, 'b', 0) is JoinResult.WAIT
    assert offer(join, 'a', 0) is JoinResult.COMPLETE
    assert join.take() == (0, {'a': 'a0', 'b': 'b0'})


def test_only_the_trigger_requests_the_reply_again():
    join = StampJoin(['a', 'b'])
    offer(join, 'a', 0)
    offer(join, 'b', 0)
    join.take()
    assert offer(join, 'a', 0) is JoinResult.REPEAT
    assert offer(join, 'b', 0) is JoinResult.IGNORE


def test_an_older_stamp_is_dropped_unless_the_trigger_begins_another_run():
    join = StampJoin(['a', 'b'])
    for step in (0, 1, 2):
        offer(join, 'a', step)
        offer(join, 'b', step)
        join.take()
    assert offer(join, 'a', 1) is JoinResult.IGNORE
    assert offer(join, 'b', 0) is JoinResult.IGNORE
    assert offer(join, 'a', 0) is JoinResult.BEGUN_ANEW


def test_a_repeated_input_of_an_open_stamp_does_not_complete_it():
    join = StampJoin(['a', 'b'])
    assert offer(join, 'a', 0) is JoinResult.WAIT
    assert offer(join, 'a', 0) is JoinResult.WAIT


@pytest.mark.parametrize('first', [1, 5])
def test_a_node_that_joins_mid_run_ends_with_an_error(first):
    with refused(DdctError, 'a'):
        offer(StampJoin(['a']), 'a', first)


def test_a_gap_is_passed_over_where_gaps_are_allowed():
    join = StampJoin(['a'], allow_gaps=True)
    offer(join, 'a', 0)
    join.take()
    assert offer(join, 'a', 3) is JoinResult.COMPLETE
    assert join.take() == (3, {'a': 'a3'})


def test_inputs_of_skipped_steps_are_removed():
    join = StampJoin(['a', 'b'], allow_gaps=True)
    offer(join, 'a', 0)
    offer(join, 'a', 1)
    offer(join, 'b', 1)
    assert join.take() == (1, {'a': 'a1', 'b': 'b1'})
    assert offer(join, 'b', 0) is JoinResult.IGNORE
    assert not join._waiting


def test_a_stamp_off_the_grid_is_an_error():
    with refused(DdctError, 'a'):
        StampJoin(['a']).offer('a', stamp_of_step(0) + 1, None)


def test_in_lock_step_stamps_that_wait_without_end_are_an_error():
    join = StampJoin(['a', 'b'])
    for step in range(MOST_WAITING):
        offer(join, 'b', step)
    with pytest.raises(DdctError, match=f'b: step {MOST_WAITING} came while 10 others wait'):
        offer(join, 'b', MOST_WAITING)


def test_errors_show_topics_by_the_names_that_they_are_given():
    join = StampJoin(['a', 'b'], shown=lambda topic: f'side/{topic}')
    with refused(DdctError, 'side/a'):
        join.offer('a', stamp_of_step(0) + 1, None)
    for step in range(1, 1 + MOST_WAITING):
        offer(join, 'b', step)
    with pytest.raises(DdctError, match=r'^side/b: .* publishes side/a and side/b$'):
        offer(join, 'b', 1 + MOST_WAITING)
    with refused(DdctError, 'side/a'):
        offer(join, 'a', 1)


def test_where_gaps_are_allowed_the_oldest_stamp_that_waits_is_given_up():
    join = StampJoin(['a', 'b'], allow_gaps=True)
    for step in range(MOST_WAITING + 1):
        offer(join, 'b', step)
    assert offer(join, 'a', 0) is JoinResult.WAIT
    assert offer(join, 'a', 2) is JoinResult.COMPLETE
