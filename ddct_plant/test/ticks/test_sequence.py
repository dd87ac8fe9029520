# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Sequence numbers distinguish two publishers from one, and from a restarted one."""

from itertools import chain

import pytest

from ddct_plant.ticks.sequence import SequenceWatch


def two_alive(numbers):
    watch = SequenceWatch()
    for number in numbers:
        watch.note(number)
    return watch.two_alive


def in_turns(first, second, steps=6):
    return chain.from_iterable((first + i, second + i) for i in range(steps))


@pytest.mark.parametrize('second', [1, 49, 50, 51, 52, 4000])
def test_sequences_that_alternate_prove_two_publishers(second):
    assert two_alive(in_turns(50, second))


def test_bursts_of_two_publishers_are_two():
    assert two_alive([*range(5), *range(90, 99), *range(5, 8), 99, 8, 100, 9])


def test_one_publisher_is_one_whatever_is_lost():
    assert not two_alive(number for number in range(5000) if number % 7 and number % 31)


def test_a_publisher_that_is_killed_and_started_again_is_one():
    assert not two_alive([*range(40, 100), *range(1, 300), *range(1, 60), *range(2, 200)])


def test_two_publishers_are_not_proven_by_a_single_return():
    assert not two_alive([10, 11, 3, 4, 12, 13])
