# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Decode the serialised messages of a bag, without ROS."""

from collections import defaultdict
from collections.abc import Callable
from typing import Any

from mcap_ros2.decoder import DecoderFactory

from ddct_bringup.bag.file.cdr import CdrDecoder
from ddct_bringup.bag.file.message_definitions import load_definition
from ddct_bringup.bag.file.records import BagRecords
from ddct_plant.base.errors import DdctError
from ddct_plant.signals.message_kind import stamp_ns
from ddct_plant.signals.topics import all_topics

Decode = Callable[[bytes], Any]
"""Function that returns the message in serialised bytes."""


def decoded_messages(records: BagRecords) -> dict[str, list[tuple[int, Any]]]:
    """Return the (stamp in ns, message) pairs of each known topic, in the order of the file."""
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
            raise DdctError(f'{topic} at {log_time} ns carries the stamp {stamp} ns', key=topic)
        messages[topic].append((stamp, message))
    return dict(messages)


def _decoders(records: BagRecords) -> dict[str, Decode]:
    """Return a decoder for each known topic; raise DdctError for a topic of another type."""
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
            raise DdctError(
                f'{channel.topic} does not carry CDR messages of type {type_name}',
                key=channel.topic,
            )
        decoders[channel.topic] = _fast(decoder, type_name, schema.data)
    return decoders


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
