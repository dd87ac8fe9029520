# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Read the stamp of serialised messages, and make them reproducible to the byte.

CDR aligns numbers with bytes that the ROS serialiser does not set, and `rclpy.serialization` may
leave such bytes behind the end. Both would differ from run to run. To read and serialise each
message again, as headless bags are written, takes 40 to 290 us a message; to set the bytes to zero
takes 0.3 to 2.5 us.
"""

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ddct_plant.bag_file.cdr_walk import BODY, HEADER, Walk
from ddct_plant.bag_file.message_definitions import MessageDefinition
from ddct_plant.base.errors import DdctError
from ddct_plant.signals.message_kind import NS_PER_S

_STAMP = struct.Struct('<iI')
"""Layout of the stamp, with which every recorded type begins, right behind the header."""

_LAYOUTS_KEPT = 32
"""Number of layouts cached per message size; numbers as text have a few lengths each."""


def stamp_of_cdr(cdr: bytes) -> int:
    """Return the stamp in ns of a serialised message."""
    seconds, nanoseconds = _STAMP.unpack_from(cdr, BODY)
    return seconds * NS_PER_S + nanoseconds


@dataclass(frozen=True)
class MessageLayout:
    """Places of the values in a message; the masks are each read as one little-endian integer."""

    walk: Walk
    keep: int
    """Mask with ones over every byte that carries a value."""
    lengths: int
    """Mask with ones over the header and the lengths, on which the layout depends."""
    length_values: int


class MessageLayouts:
    """Layouts of the messages of one type."""

    def __init__(self, definition: MessageDefinition) -> None:
        self._definition = definition
        self._layouts: dict[int, list[MessageLayout]] = {}

    def layout(self, cdr: bytes, value: int) -> MessageLayout:
        """
        Return the layout of a message; `value` is the message as one little-endian integer.

        Raise DdctError for a message of another type.
        """
        known = self._layouts.setdefault(len(cdr), [])
        # Equal lengths at the same places mean the same layout, so a walk is seldom needed. With
        # a walk for each message `tools/run bench` shows 2.5 for one process, not 1.6.
        for layout in known:
            if value & layout.lengths == layout.length_values:
                return layout
        found = self._found(cdr, value)
        known.insert(0, found)
        del known[_LAYOUTS_KEPT:]
        return found

    def _found(self, cdr: bytes, value: int) -> MessageLayout:
        type_name = self._definition.type_name
        try:
            if cdr[: len(HEADER)] != HEADER:
                raise ValueError('not little-endian CDR')
            walk = Walk(self._definition, cdr)
        except struct.error as error:
            raise DdctError(
                f'a message is no {type_name}: it is cut short', key=type_name
            ) from error
        except ValueError as error:
            raise DdctError(f'a message is no {type_name}: {error}', key=type_name) from error
        depends = _ones(walk.size, walk.lengths)
        keep = _ones(walk.size, [range(walk.size)]) & ~_ones(walk.size, walk.gaps)
        return MessageLayout(walk, keep, depends, value & depends)


class CdrNormaliser:
    """Normaliser of one message type: sets alignment bytes to zero and cuts trailing bytes."""

    def __init__(self, definition: MessageDefinition) -> None:
        self._layouts = MessageLayouts(definition)

    def normalise(self, cdr: bytes) -> bytes:
        """Return the message with zeros between its values; raise DdctError for another type."""
        value = int.from_bytes(cdr, 'little')
        layout = self._layouts.layout(cdr, value)
        return (value & layout.keep).to_bytes(layout.walk.size, 'little')


class CdrDecoder:
    """Decoder of the messages of one type, many times as fast as a general one."""

    def __init__(self, definition: MessageDefinition) -> None:
        self._layouts = MessageLayouts(definition)

    def __call__(self, cdr: bytes) -> Any:
        """Return a message with the fields of its type; raise DdctError for another type."""
        return self._layouts.layout(cdr, int.from_bytes(cdr, 'little')).walk.message(cdr)


def _ones(size: int, places: Sequence[range]) -> int:
    """Return the mask of `size` bytes with ones over the bytes in `places`."""
    mask = bytearray(size)
    for place in places:
        mask[place.start : place.stop] = b'\xff' * len(place)
    return int.from_bytes(mask, 'little')
