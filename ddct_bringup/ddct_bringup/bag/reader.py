"""Read a recorded bag back into a trajectory and what else it says; needs no ROS."""

from collections import defaultdict
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from mcap_ros2.decoder import DecoderFactory

from ddct_bringup.bag.file.records import BagRecords, read_records
from ddct_bringup.bag.run_facts import (
    MEASURED,
    RealtimeFacts,
    RunFacts,
    RunInfoOfNodes,
    note_run_info,
)
from ddct_bringup.bag.ticks import check_ticks
from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import stamp_of_step
from ddct_plant.files.input_file import SCHEMA_KEY, located, mcap_of
from ddct_plant.files.yaml_text import parse_yaml
from ddct_plant.graph.message_kinds import stamp_ns
from ddct_plant.graph.topics import (
    DIAGNOSTICS,
    JOINT_STATES,
    RUN_INFO,
    Topic,
    all_topics,
    recorded_topics,
)
from ddct_plant.scenario.file import scenario_from_mapping
from ddct_plant.scenario.settings import RunSettings


@dataclass(frozen=True)
class Recording:
    """What a whole bag holds."""

    path: Path
    """The MCAP file."""
    trajectory: Trajectory
    facts: RunFacts
    custom_data: dict[str, str] = field(default_factory=dict)
    run_info: RunInfoOfNodes = field(default_factory=dict)
    """Per node name its parameters and version."""
    counts: dict[str, int] = field(default_factory=dict)
    """Messages per resolved topic name."""
    missed: dict[str, int] = field(default_factory=dict)
    """Per reply topic, at how many stamps the last reply had to be held; real time only."""
    realtime: RealtimeFacts = field(default_factory=RealtimeFacts)
    """What `/diagnostics` says; empty in lock-step."""
    absent: Mapping[str, str] = field(default_factory=dict)
    """Of a log of another tool: quantities that it does not have, NaN here, and why."""
    simulated: RunSettings | None = None
    """What was simulated here, and so need not be read."""

    @cached_property
    def settings(self) -> RunSettings | None:
        """What was simulated; None where the bag does not tell, or it cannot be built here."""
        if self.simulated is not None:
            return self.simulated
        facts = self.facts
        try:
            return RunSettings(
                scenario_from_mapping(self._scenario),
                facts.architecture,
                facts.clutch,
                facts.wear_gain,
                facts.mode,
                facts.seed,
            )
        except (DdctError, TypeError, ValueError):
            return None

    @property
    def measured(self) -> bool:
        """Whether it is the log of another tool: then nothing of ours lies beside it."""
        return self.facts.mode == MEASURED

    @property
    def before_schema(self) -> bool:
        """Whether the bag is older than the version numbers of scenarios."""
        return not isinstance(self._scenario, dict) or SCHEMA_KEY not in self._scenario

    @cached_property
    def _scenario(self) -> Any:
        """Content of the recorded scenario, None without a readable one."""
        try:
            return parse_yaml(self.custom_data.get('scenario_yaml', ''))
        except DdctError:
            return None


def read_bag(path: Path) -> Recording:
    """
    Read a bag folder or its .mcap file.

    Raise DdctError for a missing, unfinished, damaged or foreign bag, for a message that is
    missing, doubled or cannot be decoded, and for a node that says two things on `run_info`. A run
    that ended early, or that holds non-finite values, is no error here.
    """
    records = read_records(mcap_of(path))
    with located(str(records.path)):
        return recording_of(records)


def recording_of(records: BagRecords) -> Recording:
    """Decode the records of a bag; raise the errors of `read_bag`, without the file's name."""
    if JOINT_STATES.resolved_name not in records.topics:
        raise DdctError(f'no topic {JOINT_STATES.resolved_name}: not a recording of this project')
    facts = RunFacts.from_custom_data(records.custom_data)
    messages = _decode(records)
    stamps = {topic: [stamp for stamp, _ in each] for topic, each in messages.items()}
    run = facts.kind_of_bag(messages)
    last = check_ticks(stamps, run)
    columns: dict[str, tuple[Any, ...]] = {}
    missed: dict[str, int] = {}
    for topic in recorded_topics(run):
        if not topic.signals:
            continue
        rows, held = _rows(topic, messages.get(topic.resolved_name, []), last)
        signals = topic.signals_in(run)
        if len(rows[0]) != len(signals):
            raise DdctError(
                f'{topic.resolved_name}: a message has {len(rows[0])} values, not the '
                f'{len(signals)} of a {run.clutch} run'
            )
        for signal, column in zip(signals, zip(*rows, strict=True), strict=True):
            columns[signal.name] = column
        if held:
            missed[topic.name] = held
    return Recording(
        path=records.path,
        trajectory=Trajectory.of_columns(columns),
        facts=facts,
        custom_data=records.custom_data,
        run_info=_run_info(messages.get(RUN_INFO.resolved_name, [])),
        counts={topic: len(each) for topic, each in messages.items()},
        missed=missed,
        realtime=_realtime(messages.get(DIAGNOSTICS.resolved_name, [])),
    )


def _realtime(messages: list[tuple[int, Any]]) -> RealtimeFacts:
    facts = RealtimeFacts()
    for _, message in messages:
        if message.status:
            facts.hear(*DIAGNOSTICS.read(message))
    return facts


def _decode(records: BagRecords) -> dict[str, list[tuple[int, Any]]]:
    """Return per topic of ours its (stamp in ns, message), in the order of the file."""
    decoders = _decoders(records)
    messages: dict[str, list[tuple[int, Any]]] = defaultdict(list)
    for topic, log_time, data in records.messages:
        if (decode := decoders.get(topic)) is None:
            continue
        try:
            message = decode(data)
            stamp = stamp_ns(message)
        except Exception as error:  # the decoder has no common base of its errors
            raise DdctError(f'{topic} at {log_time} ns cannot be decoded ({error})') from error
        if stamp != log_time:
            raise DdctError(f'{topic} at {log_time} ns carries the stamp {stamp} ns')
        messages[topic].append((stamp, message))
    return dict(messages)


def _decoders(records: BagRecords) -> dict[str, Callable[[bytes], Any]]:
    """Return a decoder for each topic of ours; raise DdctError for one of another type."""
    factory = DecoderFactory()
    ours = {topic.resolved_name: topic.type for topic in all_topics()}
    decoders = {}
    for channel in records.channels.values():
        if (type_name := ours.get(channel.topic)) is None:
            continue
        schema = records.schemas.get(channel.schema_id)
        try:
            decoder = factory.decoder_for(channel.message_encoding, schema)
        except Exception as error:  # the decoder has no common base of its errors
            raise DdctError(f'{channel.topic}: unusable message definition ({error})') from error
        if schema is None or schema.name != type_name or decoder is None:
            raise DdctError(f'{channel.topic} does not carry CDR messages of type {type_name}')
        decoders[channel.topic] = decoder
    return decoders


def _rows(
    topic: Topic, messages: list[tuple[int, Any]], last: int
) -> tuple[list[tuple[Any, ...]], int]:
    """
    Return the values at t_0..t_N, and at how many of these stamps there was no message.

    There the last message before counts; before the first message, the first one.
    """
    if not messages:
        raise DdctError(f'no message on {topic.resolved_name}')
    try:
        values = {stamp: topic.values(message) for stamp, message in messages}
    except (LookupError, AttributeError) as error:
        raise DdctError(f'{topic.resolved_name}: a message lacks a value ({error})') from error
    row = values[min(values)]
    rows, held = [], 0
    for step in range(last + 1):
        found = values.get(stamp_of_step(step))
        held += found is None
        row = row if found is None else found
        rows.append(row)
    return rows, held


def _run_info(messages: list[tuple[int, Any]]) -> RunInfoOfNodes:
    said: RunInfoOfNodes = {}
    for _, message in messages:
        note_run_info(said, *RUN_INFO.read(message))
    return said
