# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Find the complete ticks of a recording, by the stamps of its messages alone."""

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import count

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import stamp_of_step, step_of_stamp, time_of_step
from ddct_plant.signals.topic import RunKind
from ddct_plant.signals.topics import JOINT_STATES, recorded_topics

Stamps = Mapping[str, Sequence[int]]
"""Stamps in ns of a topic's messages, by resolved topic name."""


BEFORE_FIRST_TICK = 'the recording ends before its first tick: record the run again'
"""Error of an unfinished recording without a whole tick."""


def tick_topics(run: RunKind, *, replies: bool) -> list[str]:
    """Return the resolved names of the topics of a tick, with or without the `replies` to it."""
    return [
        topic.resolved_name
        for topic in recorded_topics(run)
        if topic.is_tick or (topic.every_tick and replies)
    ]


def last_whole_tick(stamps: Stamps, run: RunKind) -> int:
    """
    Return the stamp in ns of the last tick before the first that lacks a message.

    In real time a tick may lack replies. Raise DdctError where the first tick lacks one.
    """
    topics = tick_topics(run, replies=run.lockstep)
    whole = set(stamps.get(topics[0], ())).intersection(*(stamps.get(name, ()) for name in topics))
    step = next(step for step in count() if stamp_of_step(step) not in whole)
    if not step:
        raise DdctError(BEFORE_FIRST_TICK)
    return stamp_of_step(step - 1)


def check_ticks(stamps: Stamps, run: RunKind) -> int:
    """
    Return N when every required topic has a message at each of t_0..t_N.

    N is the last step of the joint states. In lock-step all topics of a tick are required; in real
    time replies may be missing. Raise DdctError that names the topic and stamp of a missing,
    doubled or misplaced message.
    """
    joint_states = JOINT_STATES.resolved_name
    if not stamps.get(joint_states):
        raise DdctError(
            f'no message on {joint_states}: not a recording of this project', key=joint_states
        )
    for topic in tick_topics(run, replies=True):
        _check_single(topic, stamps.get(topic, ()))
    last = step_of_stamp(max(stamps[joint_states]))
    for topic in tick_topics(run, replies=run.lockstep):
        found = set(stamps.get(topic, ()))
        if not found:
            raise DdctError(f'no message on {topic}', key=topic)
        for step in range(last + 1):
            if stamp_of_step(step) not in found:
                raise DdctError(f'{topic} has no message at {_place(step)}', key=topic)
        if max(found) > stamp_of_step(last):
            raise DdctError(f'{topic} goes on after the last tick at {_place(last)}', key=topic)
    return last


def _check_single(topic: str, stamps: Sequence[int]) -> None:
    for stamp, number in Counter(stamps).items():
        try:
            step = step_of_stamp(stamp)
        except DdctError as error:
            raise DdctError(f'{topic}: {error}', key=topic) from error
        if number > 1:
            raise DdctError(f'{topic} has {number} messages at {_place(step)}', key=topic)


def _place(step: int) -> str:
    return f'step {step} ({time_of_step(step):g} s, stamp {stamp_of_step(step)} ns)'
