# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Decode the serialised messages of a bag, without ROS."""

import io
from collections.abc import Callable, Collection, Iterator
from contextlib import redirect_stderr
from typing import Any

from mcap.records import Channel, Schema
from mcap_ros2.decoder import DecoderFactory

from ddct_plant.bag_file.cdr import CdrDecoder
from ddct_plant.bag_file.message_definitions import load_definition
from ddct_plant.bag_file.records import BagRecords
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
    known = {topic.resolved_name: topic for topic in chosen or all_topics()}
    channels = {channel.topic for channel in records.channels.values()}
    decoders = {name: _decoder(records, known[name]) for name in known.keys() & channels}
    for name, log_time, data in records.messages():
        if (topic := known.get(name)) is None:
            continue
        if name not in decoders:
            decoders[name] = _decoder(records, topic)
        try:
            message = decoders[name](data)
            stamp = stamp_ns(message)
        except Exception as error:  # the decoder has no common base of its errors
            raise DdctError(f'{name} at {log_time} ns cannot be decoded ({error})') from error
        if stamp != log_time:
            raise DdctError(f'{name} at {log_time} ns carries the stamp {stamp} ns', key=name)
        yield topic, stamp, message


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
    return _fast(decoder, topic.type, schema.data)


def _fast(general: Decode, type_name: str, schema: bytes) -> Decode:
    """Return a decoder that gives messages like `general`, in less time where it can."""
    definition = load_definition(type_name)
    if schema != definition.schema_text.encode():  # of an earlier version, or another recorder
        return general
    decoder = CdrDecoder(definition)

    def decode(data: bytes) -> Any:
        try:
            return decoder(data)
        except Exception:  # the general decoder takes other encodings, or has the reason
            return general(data)

    return decode
