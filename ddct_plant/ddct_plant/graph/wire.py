# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Messages of a topic as bytes: what nodes send and receive in place of rclpy's messages.

At 100 Hz, to receive a message of rclpy takes two to three times as long as to receive its bytes,
and to publish one takes half as long again. To decode or fill the bytes here takes a few us.
"""

from collections.abc import Callable

from rclpy.serialization import serialize_message

from ddct_plant.bag_file.cdr import CdrDecoder
from ddct_plant.bag_file.cdr_numbers import message_serialiser
from ddct_plant.bag_file.message_definitions import load_definition
from ddct_plant.signals.topic import Topic


def serialiser(topic: Topic) -> Callable[..., bytes]:
    """Return a function `serialise(stamp_ns, *values, **options)` for messages of a topic."""
    return message_serialiser(topic.kind, topic.writer(), serialize_message)


def decoder(topic: Topic) -> CdrDecoder:
    """
    Return the decoder of the messages of a topic.

    It raises DdctError for others, and UnicodeDecodeError for a text that is none.
    """
    return CdrDecoder(load_definition(topic.type))
