# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Read a recorded bag into a trajectory and its facts, without ROS."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ddct_bringup.bag.realtime_facts import RealtimeFacts
from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.run_facts import described_run
from ddct_bringup.bag.run_info import RUN_INFO_TOPICS, RunInfoOfNodes, add_run_info
from ddct_bringup.bag.ticks import BEFORE_FIRST_TICK, check_ticks, last_whole_tick
from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.bag_file.decoding import Column, TopicColumns, read_columns
from ddct_plant.bag_file.records import BagRecords, read_records
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import PERIOD_NS, START_NS, time_of_step
from ddct_plant.files.input_file import located, mcap_of
from ddct_plant.graph.node_names import StatusName, name_in_graph
from ddct_plant.signals.topic import RunKind, Topic
from ddct_plant.signals.topics import DIAGNOSTICS, JOINT_STATES, recorded_topics


def read_bag(path: Path) -> Recording:
    """
    Read a bag folder or its .mcap file; one without a footer up to its last whole tick.

    Raise DdctError for a missing, damaged or foreign bag, for a message that is missing, doubled
    or cannot be decoded, and for a node with two different messages on `run_info`. A run that
    ended early, or that has non-finite values, is no error here.
    """
    records = read_records(mcap_of(path))
    with located(str(records.path)):
        return recording_of(records)


def recording_of(records: BagRecords) -> Recording:
    """Decode the records of a bag; raise the errors of `read_bag`, without the file's name."""
    _require_joint_states(records)
    settings, facts = described_run(records.custom_data)
    run = facts.kind_of_bag(records.topics)
    found = _found(records, run)
    last = check_ticks({name: each.stamps.tolist() for name, each in found.items()}, run)
    if last > facts.steps:
        raise DdctError(
            f'duration_s is {facts.duration_s:g} in its settings, but its last tick is at '
            f'{time_of_step(last):g} s: take the original bag',
            key='duration_s',
        )
    columns: dict[str, Column] = {}
    missed: dict[str, int] = {}
    absent: dict[str, str] = {}
    for topic in _topics_with_signals(run):
        each = found[topic.resolved_name]
        if not each.stamps.size:
            if not topic.optional:
                raise DdctError(f'no message on {topic.resolved_name}', key=topic.resolved_name)
            reason = f'the node {topic.publisher} did not publish {topic.name}'
            absent |= dict.fromkeys((signal.name for signal in topic.signals), reason)
            continue
        at_ticks, missing = _at_ticks(each, last)
        columns |= at_ticks
        if missing and topic.in_run(run):
            missed[topic.name] = missing
    return Recording(
        path=records.path,
        trajectory=Trajectory.of_columns(columns),
        facts=facts,
        custom_data=records.custom_data,
        run_info=_run_info(found),
        missed=missed,
        realtime=_realtime(found[DIAGNOSTICS.resolved_name].messages),
        absent=absent,
        unfinished=records.unfinished,
        settings=settings,
    )


def _require_joint_states(records: BagRecords) -> None:
    if JOINT_STATES.resolved_name in records.topics:
        return
    if records.unfinished:
        raise DdctError(BEFORE_FIRST_TICK)
    raise DdctError(
        f'no topic {JOINT_STATES.resolved_name}: not a recording of this project',
        key=JOINT_STATES.resolved_name,
    )


def _found(records: BagRecords, run: RunKind) -> dict[str, TopicColumns]:
    """Return the messages of a bag by resolved name, of an unfinished one those of whole ticks."""
    topics = {topic: topic.signals_in(run) for topic in _topics(run)}
    found = {topic.resolved_name: each for topic, each in read_columns(records, topics).items()}
    if not records.unfinished:
        return found
    last = last_whole_tick({name: each.stamps.tolist() for name, each in found.items()}, run)
    return {name: each.until(last) for name, each in found.items()}


def _topics(run: RunKind) -> set[Topic]:
    """Return the topics that a run of this kind has, or that say something of it."""
    return {*recorded_topics(replace(run, torque_parts=True)), *RUN_INFO_TOPICS, DIAGNOSTICS}


def _topics_with_signals(run: RunKind) -> list[Topic]:
    """Return the topics whose signals a run of this kind has, those that are optional too."""
    topics = recorded_topics(replace(run, torque_parts=True))
    return [topic for topic in topics if topic.signals]


def _at_ticks(topic: TopicColumns, last: int) -> tuple[dict[str, Column], int]:
    """
    Return the columns at t_0..t_N by signal, and the number of these stamps without a message.

    A column has (N+1,) or (N+1, n) numbers, or N + 1 other values. A stamp without a message
    repeats the last one before; before the first message, the first.
    """
    steps = (topic.stamps - START_NS) // PERIOD_NS
    index = np.full(last + 1, -1)
    at_tick = np.flatnonzero(steps <= last)
    index[steps[at_tick]] = at_tick
    before = np.maximum.accumulate(np.where(index >= 0, np.arange(last + 1), -1))
    rows = np.where(before >= 0, index[before], int(np.argmin(topic.stamps)))
    columns: dict[str, Column] = {}
    for signal, column in zip(topic.signals, topic.values, strict=True):
        if isinstance(column, np.ndarray):
            columns[signal.name] = column[rows]
        else:
            columns[signal.name] = tuple(column[row] for row in rows)
    return columns, int(np.count_nonzero(index < 0))


def _realtime(messages: Sequence[Any]) -> RealtimeFacts:
    facts = RealtimeFacts()
    for message in messages:
        if message.status:
            name, pairs = DIAGNOSTICS.read(message)
            facts.receive(StatusName.of(name), pairs)
    return facts


def _run_info(found: Mapping[str, TopicColumns]) -> RunInfoOfNodes:
    received: RunInfoOfNodes = {}
    for topic in RUN_INFO_TOPICS:
        for message in found[topic.resolved_name].messages:
            node, pairs = topic.read(message)
            add_run_info(received, name_in_graph(node), pairs)
    return received
