# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Decode the serialised messages of a bag, without ROS."""

import io
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import redirect_stderr
from typing import Any

import numpy as np
from mcap.records import Channel, Schema
from mcap_ros2.decoder import DecoderFactory

from ddct_plant.bag_file.cdr import CdrDecoder
from ddct_plant.bag_file.message_definitions import MessageDefinition, load_definition
from ddct_plant.bag_file.records import BagRecords, StoredMessage
from ddct_plant.base.errors import DdctError
from ddct_plant.signals.message_kind import stamp_ns
from ddct_plant.signals.topic import Topic
from ddct_plant.signals.topics import all_topics

Decode = Callable[[bytes], Any]
"""Function that returns the message in serialised bytes."""


def decoded_messages(
    records: BagRecords, chosen: Collection[Topic] | None = None
) -> Iterator[tuple[Topic, int, Any]]:
    """
    Yield (topic, stamp in ns, message) of each message on a known topic, in the order of the file.

    Only topics in `chosen` are decoded, if given. Raise DdctError for a damaged bag, for a topic
    of another type and for a message that cannot be decoded.
    """
    decoders = _Decoders(records, chosen or all_topics())
    for stored in records.messages():
        yield from decoders.one(stored)


def decoded_columns(
    records: BagRecords, numbers: Collection[Topic]
) -> Iterator[tuple[Topic, int | np.ndarray, Any]]:
    """
    Yield as `decoded_messages`, but the messages on topics in `numbers` together where possible.

    Those of one chunk and topic that differ in numbers alone are yielded as one message whose
    numbers are (n,) arrays, with their (n,) stamps, before other messages of the chunk.
    """
    decoders = _Decoders(records, all_topics())
    names = {topic.resolved_name for topic in numbers}
    for batch in records.batches():
        together: dict[str, list[StoredMessage]] = {}
        apart = []
        for stored in batch:
            if stored[0] in names:
                together.setdefault(stored[0], []).append(stored)
            else:
                apart.append(stored)
        for group in together.values():
            if (columns := decoders.columns(group)) is not None:
                yield columns
            else:
                apart += group
        for stored in apart:
            yield from decoders.one(stored)


class _Decoders:
    """Decoders of the messages of a bag by topic."""

    def __init__(self, records: BagRecords, topics: Collection[Topic]) -> None:
        """Begin with the channels of a bag; raise DdctError where a topic has another type."""
        self._records = records
        self._known = {topic.resolved_name: topic for topic in topics}
        channels = {channel.topic for channel in records.channels.values()}
        self._decoders: dict[str, Decode] = {}
        for name in self._known.keys() & channels:
            self._of(name)

    def _of(self, name: str) -> Decode:
        if name not in self._decoders:
            self._decoders[name] = _decoder(self._records, self._known[name])
        return self._decoders[name]

    def one(self, stored: StoredMessage) -> Iterator[tuple[Topic, int, Any]]:
        """Yield a message on a known topic; raise DdctError where it cannot be decoded."""
        name, log_time, data = stored
        if (topic := self._known.get(name)) is None:
            return
        decode = self._of(name)
        try:
            message = decode(data)
            stamp = stamp_ns(message)
        except Exception as error:  # the decoder has no common base of its errors
            raise DdctError(f'{name} at {log_time} ns cannot be decoded ({error})') from error
        if stamp != log_time:
            raise DdctError(f'{name} at {log_time} ns carries the stamp {stamp} ns', key=name)
        yield topic, stamp, message

    def columns(self, group: Sequence[StoredMessage]) -> tuple[Topic, np.ndarray, Any] | None:
        """Return messages on a topic as one; None where each must be decoded by itself."""
        name = group[0][0]
        decode = self._of(name)
        if not isinstance(decode, FastDecoder):
            return None
        message = decode.columns([data for _, _, data in group])
        if message is None:
            return None
        stamps: Any = stamp_ns(message)
        if not np.array_equal(stamps, [log_time for _, log_time, _ in group]):
            return None
        return self._known[name], stamps, message


class FastDecoder:
    """Decoder of the messages of this project, which takes less time than a general one."""

    def __init__(self, general: Decode, definition: MessageDefinition) -> None:
        self._general = general
        self._fast = CdrDecoder(definition)

    def __call__(self, data: bytes) -> Any:
        """Return the message as the general decoder does, or raise its error."""
        try:
            return self._fast(data)
        except Exception:  # the general decoder takes other encodings, or has the reason
            return self._general(data)

    def columns(self, cdrs: Sequence[bytes]) -> Any:
        """Return messages as one whose numbers are arrays; None where that is not possible."""
        try:
            return self._fast.columns(cdrs)
        except Exception:  # each by itself has the reason
            return None


def _decoder(records: BagRecords, topic: Topic) -> Decode:
    """Return the decoder of a topic; raise DdctError where one of its channels has another."""
    found = [
        _decoder_of(channel, records.schemas.get(channel.schema_id), topic)
        for channel in records.channels.values()
        if channel.topic == topic.resolved_name
    ]
    return found[0]


def _decoder_of(channel: Channel, schema: Schema | None, topic: Topic) -> Decode:
    try:
        # The parser prints a line that it cannot parse, whatever bytes the file has there.
        with redirect_stderr(io.StringIO()):
            decoder = DecoderFactory().decoder_for(channel.message_encoding, schema)
    except Exception as error:  # the decoder has no common base of its errors
        raise DdctError(f'{channel.topic}: unusable message definition ({error})') from error
    if schema is None or schema.name != topic.type or decoder is None:
        raise DdctError(
            f'{channel.topic} does not carry CDR messages of type {topic.type}',
            key=channel.topic,
        )
    definition = load_definition(topic.type)
    if schema.data != definition.schema_text.encode():  # earlier, or of another recorder
        return decoder
    return FastDecoder(decoder, definition)
