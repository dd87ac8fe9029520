# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Read a recorded bag into a trajectory, its facts and counts, without ROS."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ddct_bringup.bag.realtime_facts import RealtimeFacts
from ddct_bringup.bag.recording import Recording, require_consistent
from ddct_bringup.bag.run_facts import RunFacts
from ddct_bringup.bag.run_info import RUN_INFO_TOPICS, RunInfoOfNodes, add_run_info
from ddct_bringup.bag.ticks import check_ticks
from ddct_bringup.bag.topic_values import Column, TopicValues
from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.bag_file.decoding import decoded_columns
from ddct_plant.bag_file.facts import require_last_step
from ddct_plant.bag_file.records import BagRecords, read_records
from ddct_plant.base.errors import DdctError
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
    run = facts.kind_of_bag(records.topics)
    found = _Found.of(records, run)
    last = check_ticks({name: each.stamps for name, each in found.values.items()}, run)
    require_last_step(records.custom_data, last)
    columns: dict[str, Column] = {}
    missed: dict[str, int] = {}
    absent: dict[str, str] = {}
    for topic in _topics_with_signals(run):
        values = found.values.pop(topic.resolved_name, None) or _no_values(topic, run)
        if not values.stamps:
            if not topic.optional:
                raise DdctError(f'no message on {topic.resolved_name}', key=topic.resolved_name)
            reason = f'the node {topic.publisher} did not publish {topic.name}'
            absent |= dict.fromkeys((signal.name for signal in topic.signals), reason)
            continue
        at_ticks, missing = values.at_ticks(last)
        columns |= at_ticks
        if missing and topic.in_run(run):
            missed[topic.name] = missing
    recording = Recording(
        path=records.path,
        trajectory=Trajectory.of_columns(columns),
        facts=facts,
        custom_data=records.custom_data,
        run_info=_run_info(found.messages),
        counts=dict(found.counts),
        missed=missed,
        realtime=_realtime(found.messages.get(DIAGNOSTICS.resolved_name, ())),
        absent=absent,
    )
    require_consistent(recording)
    return recording


@dataclass(frozen=True)
class _Found:
    """What is kept of the messages of a bag while it is read."""

    counts: Counter[str] = field(default_factory=Counter)
    """Number of messages by resolved topic name."""
    values: dict[str, TopicValues] = field(default_factory=dict)
    """Values of the topics of every tick that the run has, by resolved name."""
    messages: dict[str, list[tuple[int, Any]]] = field(default_factory=dict)
    """(stamp in ns, message) of the few topics whose messages are needed, by resolved name."""

    @classmethod
    def of(cls, records: BagRecords, run: RunKind) -> '_Found':
        """Decode all messages; raise DdctError for one that is unusable."""
        found = cls()
        kept = {*RUN_INFO_TOPICS, DIAGNOSTICS}
        ticks = [topic for topic in recorded_topics(run) if topic.every_tick]
        found.values.update({topic.resolved_name: _no_values(topic, run) for topic in ticks})
        numbers = [each for each in ticks if each.kind.numbers_alone and each not in kept]
        for topic, stamps, message in decoded_columns(records, numbers):
            name = topic.resolved_name
            with _values_named(topic):
                if not isinstance(stamps, int):
                    found.counts[name] += len(stamps)
                    found.values[name].add_columns(stamps, topic.values(message))
                    continue
                found.counts[name] += 1
                if topic in kept:
                    found.messages.setdefault(name, []).append((stamps, message))
                if name in found.values:
                    found.values[name].add(stamps, topic.values(message))
        return found


def _topics_with_signals(run: RunKind) -> list[Topic]:
    """Return the topics whose signals a run of this kind has, those that are optional too."""
    topics = recorded_topics(replace(run, torque_parts=True))
    return [topic for topic in topics if topic.signals]


def _no_values(topic: Topic, run: RunKind) -> TopicValues:
    return TopicValues(topic.resolved_name, topic.signals_in(run))


@contextmanager
def _values_named(topic: Topic) -> Iterator[None]:
    """Raise DdctError that names the topic where a message lacks a value."""
    try:
        yield
    except DdctError as error:
        raise error if error.key else error.at(topic.resolved_name) from error
    except (LookupError, AttributeError, ValueError, TypeError) as error:
        raise DdctError(
            f'{topic.resolved_name}: a message lacks a value ({error})', key=topic.resolved_name
        ) from error


def _realtime(messages: Sequence[tuple[int, Any]]) -> RealtimeFacts:
    facts = RealtimeFacts()
    for _, message in messages:
        if message.status:
            name, pairs = DIAGNOSTICS.read(message)
            facts.receive(StatusName.of(name), pairs)
    return facts


def _run_info(messages: Mapping[str, Sequence[tuple[int, Any]]]) -> RunInfoOfNodes:
    received: RunInfoOfNodes = {}
    for topic in RUN_INFO_TOPICS:
        for _, message in messages.get(topic.resolved_name, ()):
            node, pairs = topic.read(message)
            add_run_info(received, name_in_graph(node), pairs)
    return received
