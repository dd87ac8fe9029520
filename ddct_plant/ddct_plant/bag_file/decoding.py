# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Decode the messages of a bag to columns of values, without ROS."""

from collections import defaultdict
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from mcap.records import Channel, Schema

from ddct_plant.bag_file.message_definitions import decode, same_definition
from ddct_plant.bag_file.number_columns import NumberColumns
from ddct_plant.bag_file.records import BagRecords
from ddct_plant.base.errors import DdctError
from ddct_plant.signals.message_kind import stamp_ns
from ddct_plant.signals.topic import Signal, Topic

Column = np.ndarray | tuple[object, ...]
"""Values of a signal: (n,) or (n, size) numbers, or n texts or events."""

_TOGETHER = 512
"""Number of messages of a topic that are decoded at once; it bounds the memory of a long bag."""


@dataclass
class TopicColumns:
    """Messages of a topic in the order of the file: their stamps, and their values by signal."""

    signals: Sequence[Signal] = ()
    """Signals of the topic in this run."""
    stamps: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    """(n,) stamps in ns."""
    values: list[Column] = field(default_factory=list)
    """A column per signal; none without a message."""
    messages: list[Any] = field(default_factory=list)
    """The messages themselves, of a topic that has none at each tick."""

    def until(self, stamp: int) -> 'TopicColumns':
        """Return the messages up to a stamp in ns; later ones are those behind it."""
        kept = self.stamps <= stamp
        return TopicColumns(
            self.signals,
            self.stamps[kept],
            [
                column[kept]
                if isinstance(column, np.ndarray)
                else tuple(value for value, keep in zip(column, kept, strict=True) if keep)
                for column in self.values
            ],
            self.messages,
        )


def read_columns(
    records: BagRecords, signals: Mapping[Topic, Sequence[Signal]]
) -> dict[Topic, TopicColumns]:
    """
    Decode the messages of a bag on topics given with the signals that the run has of them.

    Raise DdctError for a damaged bag, for a topic of another type, and for a message that cannot
    be decoded, carries another stamp than the bag gives it, or lacks a value.
    """
    known = {topic.resolved_name: topic for topic in signals}
    _require_types(records, signals)
    decoders = {name: _Decoder(topic, signals[topic]) for name, topic in known.items()}
    for name, log_time, cdr in records.messages():
        if decoder := decoders.get(name):
            decoder.add(log_time, cdr)
    return {known[name]: decoder.columns() for name, decoder in decoders.items()}


class _Decoder:
    """Decoder of the messages of one topic, many at once where only their numbers differ."""

    def __init__(self, topic: Topic, signals: Sequence[Signal]) -> None:
        self._topic, self._signals = topic, signals
        self._waiting: list[tuple[int, bytes]] = []
        self._layout: NumberColumns | None = None
        self._stamps: list[np.ndarray] = []
        self._parts: list[Sequence[Sequence[Any] | np.ndarray]] = []
        self._messages: list[Any] = []

    def add(self, log_time: int, cdr: bytes) -> None:
        """Add a message; raise DdctError for one among those before that is unusable."""
        self._waiting.append((log_time, cdr))
        if len(self._waiting) >= _TOGETHER:
            self._decode()

    def columns(self) -> TopicColumns:
        """Return the columns of all messages; raise DdctError for an unusable message."""
        self._decode()
        found = TopicColumns(self._signals, messages=self._messages)
        if self._stamps:
            found.stamps = np.concatenate(self._stamps)
            parts = zip(*self._parts, strict=True)
            found.values = [
                _column(self._topic, signal, part)
                for signal, part in zip(self._signals, parts, strict=True)
            ]
        return found

    def _decode(self) -> None:
        if not self._waiting:
            return
        stamps, cdrs = zip(*self._waiting, strict=True)
        self._waiting = []
        self._stamps.append(np.array(stamps))
        part = self._numbers(stamps, cdrs)
        self._parts.append(self._one_by_one(stamps, cdrs) if part is None else part)

    def _numbers(self, stamps: Sequence[int], cdrs: Sequence[bytes]) -> list[np.ndarray] | None:
        """Return the values as arrays; None where the messages differ in more than numbers."""
        if not self._topic.kind.numbers_alone:
            return None
        if self._layout is None:
            message = self._message(stamps[0], cdrs[0])
            self._layout = NumberColumns(self._topic, self._values(message))
        found = self._layout.decode(cdrs)
        return found[1] if found and np.array_equal(found[0], stamps) else None

    def _one_by_one(self, stamps: Sequence[int], cdrs: Sequence[bytes]) -> list[Any]:
        rows = []
        for stamp, cdr in zip(stamps, cdrs, strict=True):
            message = self._message(stamp, cdr)
            if self._topic.every_tick:
                rows.append(self._values(message))
            else:
                self._messages.append(message)
        return [list(column) for column in zip(*rows, strict=True)]

    def _message(self, log_time: int, cdr: bytes) -> Any:
        name = self._topic.resolved_name
        try:
            message = decode(cdr, self._topic.type)
            stamp = stamp_ns(message)
        except Exception as error:  # rosbags has no common base of its errors
            raise DdctError(f'{name} at {log_time} ns cannot be decoded ({error})') from error
        if stamp != log_time:
            raise DdctError(f'{name} at {log_time} ns carries the stamp {stamp} ns', key=name)
        return message

    def _values(self, message: Any) -> Sequence[Any]:
        """Return the values in a message; raise DdctError that names the topic without them."""
        name = self._topic.resolved_name
        try:
            values = self._topic.values(message)
        except DdctError as error:
            raise error if error.key else error.at(name) from error
        except (LookupError, AttributeError, ValueError, TypeError) as error:
            raise DdctError(f'{name}: a message lacks a value ({error})', key=name) from error
        if len(values) != len(self._signals):
            raise DdctError(
                f'{name}: a message has {len(values)} values, not the {len(self._signals)} of '
                'such a run',
                key=name,
            )
        return values


def _column(topic: Topic, signal: Signal, parts: Sequence[Sequence[Any] | np.ndarray]) -> Column:
    """Return the values of a signal in one column; raise DdctError where their sizes differ."""
    if not signal.unit:
        return tuple(value for part in parts for value in part)
    try:
        return np.concatenate([np.asarray(part, dtype=float) for part in parts])
    except ValueError as error:
        raise DdctError(
            f'{signal.name} does not have the same size at every stamp', key=topic.resolved_name
        ) from error


def _require_types(records: BagRecords, topics: Collection[Topic]) -> None:
    """Raise DdctError where a channel of one of the topics has messages of another type."""
    channels = defaultdict(list)
    for channel in records.channels.values():
        channels[channel.topic].append(channel)
    for topic in topics:
        for channel in channels[topic.resolved_name]:
            _require_type(channel, records.schemas.get(channel.schema_id), topic)


def _require_type(channel: Channel, schema: Schema | None, topic: Topic) -> None:
    name = channel.topic
    same = False
    if schema is not None and (schema.name, schema.encoding) == (topic.type, 'ros2msg'):
        try:
            same = same_definition(topic.type, schema.data.decode())
        except (DdctError, UnicodeDecodeError) as error:
            raise DdctError(f'{name}: {error}', key=name) from error
    if not same or channel.message_encoding != 'cdr':
        raise DdctError(
            f'{name} does not carry CDR messages of type {topic.type} as ROS 2 Jazzy defines it',
            key=name,
        )
