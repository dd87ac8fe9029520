# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Read a recorded bag into a trajectory, its facts and counts, without ROS."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from ddct_bringup.bag.decoding import decoded_messages
from ddct_bringup.bag.earlier_bags import Messages, Values, earlier_values
from ddct_bringup.bag.file.records import BagRecords, read_records
from ddct_bringup.bag.realtime_facts import RealtimeFacts
from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.run_facts import RunFacts
from ddct_bringup.bag.run_info import RUN_INFO_TOPICS, RunInfoOfNodes, add_run_info
from ddct_bringup.bag.ticks import check_ticks
from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import stamp_of_step
from ddct_plant.files.input_file import located, mcap_of
from ddct_plant.graph.node_names import StatusName, name_in_graph
from ddct_plant.signals.signal import RunKind
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import DIAGNOSTICS, JOINT_STATES, recorded_topics


def read_bag(path: Path) -> Recording:
    """
    Read a bag folder or its .mcap file.

    Raise DdctError for a missing, unfinished, damaged or foreign bag, for a message that is
    missing, doubled or cannot be decoded, and for a node with two different messages on
    `run_info`. A run that ended early, or that has non-finite values, is no error here.
    """
    records = read_records(mcap_of(path))
    with located(str(records.path)):
        return recording_of(records)


def recording_of(records: BagRecords) -> Recording:
    """Decode the records of a bag; raise the errors of `read_bag`, without the file's name."""
    if JOINT_STATES.resolved_name not in records.topics:
        raise DdctError(
            f'no topic {JOINT_STATES.resolved_name}: not a recording of this project',
            key=JOINT_STATES.resolved_name,
        )
    facts = RunFacts.from_custom_data(records.custom_data)
    messages = decoded_messages(records)
    stamps = {topic: [stamp for stamp, _ in each] for topic, each in messages.items()}
    run = facts.kind_of_bag(records.topics)
    last = check_ticks(stamps, run)
    columns: dict[str, tuple[Any, ...]] = {}
    missed: dict[str, int] = {}
    absent: dict[str, str] = {}
    for topic in recorded_topics(replace(run, earlier=False, torque_parts=True)):
        if not topic.signals:
            continue
        values = _values(topic, messages, run)
        if topic.optional and not values:
            reason = f'the node {topic.publisher} did not publish {topic.name}'
            absent |= dict.fromkeys((signal.name for signal in topic.signals), reason)
            continue
        rows, missing = _rows(values, last)
        signals = topic.signals_in(run)
        if len(rows[0]) != len(signals):
            raise DdctError(
                f'{topic.resolved_name}: a message has {len(rows[0])} values, not the '
                f'{len(signals)} of a {run.clutch} run'
            )
        for signal, column in zip(signals, zip(*rows, strict=True), strict=True):
            columns[signal.name] = column
        if missing and topic.in_run(run):
            missed[topic.name] = missing
    return Recording(
        path=records.path,
        trajectory=Trajectory.of_columns(columns),
        facts=facts,
        custom_data=records.custom_data,
        run_info=_run_info(messages),
        counts={topic: len(each) for topic, each in messages.items()},
        missed=missed,
        realtime=_realtime(messages.get(DIAGNOSTICS.resolved_name, [])),
        absent=absent,
    )


def _realtime(messages: list[tuple[int, Any]]) -> RealtimeFacts:
    facts = RealtimeFacts()
    for _, message in messages:
        if message.status:
            name, pairs = DIAGNOSTICS.read(message)
            facts.receive(StatusName.of(name), pairs)
    return facts


def _values(topic: Topic, messages: Messages, run: RunKind) -> Values:
    """
    Return the values of a topic by stamp.

    They are empty for an optional topic that the run lacks. Raise DdctError for no message on
    another, or a bad one.
    """
    in_run = topic.in_run(run)
    try:
        if in_run:
            received = messages.get(topic.resolved_name, ())
            values = {stamp: topic.values(message) for stamp, message in received}
        else:
            values = earlier_values(topic, messages)
    except (LookupError, AttributeError, ValueError) as error:
        raise DdctError(f'{topic.resolved_name}: a message lacks a value ({error})') from error
    if not values and (in_run or not topic.optional):
        raise DdctError(f'no message on {topic.resolved_name}', key=topic.resolved_name)
    return values


def _rows(values: Values, last: int) -> tuple[list[tuple[Any, ...]], int]:
    """
    Return the values at t_0..t_N, and the number of these stamps without a message.

    A stamp without a message repeats the last one before; before the first message, the first.
    """
    row = values[min(values)]
    rows, missing = [], 0
    for step in range(last + 1):
        found = values.get(stamp_of_step(step))
        missing += found is None
        row = row if found is None else found
        rows.append(row)
    return rows, missing


def _run_info(messages: Messages) -> RunInfoOfNodes:
    received: RunInfoOfNodes = {}
    for topic in RUN_INFO_TOPICS:
        for _, message in messages.get(topic.resolved_name, ()):
            node, pairs = topic.read(message)
            add_run_info(received, name_in_graph(node), pairs)
    return received
