# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The buffer of the recorder under arbitrary schedules: whole ticks, each once, nothing mixed."""

from hypothesis import given, settings
from hypothesis import strategies as st

from ddct_bringup.record.tick_buffer import TickBuffer
from ddct_plant.base.timebase import stamp_of_step

TOPICS = ('a', 'b', 'c')
STEPS = 15
DELAYS = st.lists(st.sampled_from([0, 0, 0, 1, 4, 40]), max_size=2)
"""How late a message comes, in messages: once, twice or never."""


def in_order(delays: list[list[int]]) -> list[tuple[str, int]]:
    """Return topic and step of the messages in the order in which they arrive."""
    sent = [(topic, step) for step in range(STEPS) for topic in TOPICS]
    arrivals = [
        (place + late, message)
        for place, (message, times) in enumerate(zip(sent, delays, strict=True))
        for late in times
    ]
    return [message for _, message in sorted(arrivals)]


MESSAGES = STEPS * len(TOPICS)
SCHEDULES = st.lists(DELAYS, min_size=MESSAGES, max_size=MESSAGES).map(in_order)
THOROUGH = settings(max_examples=80, derandomize=True, database=None, deadline=None)


def value(topic: str, step: int) -> bytes:
    return f'{topic}{step}'.encode()


def same(_topic: str, first: bytes, second: bytes) -> bool:
    return first == second


@THOROUGH
@given(SCHEDULES)
def test_in_lock_step_a_tick_comes_out_at_once_when_it_and_all_before_are_whole(schedule):
    buffer = TickBuffer(TOPICS, same)
    there: set[tuple[str, int]] = set()
    written = 0
    for topic, step in schedule:
        there.add((topic, step))
        for number, tick in buffer.offer(topic, stamp_of_step(step), value(topic, step)):
            assert number == written
            assert tick == {each: value(each, number) for each in TOPICS}
            written += 1
        assert not all((each, written) in there for each in TOPICS), 'a whole tick waits'


@THOROUGH
@given(SCHEDULES)
def test_in_real_time_each_message_is_in_one_tick_of_its_own_or_counted(schedule):
    buffer = TickBuffer(TOPICS, same, wait_for_all=False)
    out: list[tuple[int, dict[str, bytes]]] = []
    for topic, step in schedule:
        out += buffer.offer(topic, stamp_of_step(step), value(topic, step))
    out += buffer.drain()
    steps = [step for step, _ in out]
    assert steps == sorted(set(steps))
    written = {(topic, step) for step, tick in out for topic in tick}
    assert all(cdr == value(topic, step) for step, tick in out for topic, cdr in tick.items())
    assert written <= set(schedule)
    assert len(set(schedule) - written) <= buffer.dropped, 'lost without a word'
