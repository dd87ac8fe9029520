"""
Read the stamp of serialised messages, and make them reproducible to the byte.

CDR aligns numbers with bytes that the ROS serialiser leaves as it finds them in memory, and
`rclpy.serialization` may also leave such bytes behind the end. Both would differ from run to run.
"""

import struct
from collections.abc import Sequence
from dataclasses import dataclass

from ddct_bringup.bag.file.message_definitions import PRIMITIVES, STRING, MessageDefinition
from ddct_plant.base.errors import DdctError
from ddct_plant.graph.message_kinds import NS_PER_S

_HEADER = b'\x00\x01'
"""First bytes of plain little-endian CDR; two option bytes follow, then the body."""
_BODY = 4
_STAMP = struct.Struct('<iI')
"""With it every recorded type begins, right behind the header."""

_LAYOUTS_KEPT = 32
"""Layouts remembered per message size; numbers written as text have a few lengths each."""


def stamp_of_cdr(cdr: bytes) -> int:
    """Return the stamp in ns of a serialised message."""
    seconds, nanoseconds = _STAMP.unpack_from(cdr, _BODY)
    return seconds * NS_PER_S + nanoseconds


@dataclass(frozen=True)
class _Layout:
    """Masks over the whole message, read as one little-endian integer."""

    size: int
    keep: int
    """Ones over every byte that carries a value."""
    lengths: int
    """Ones over every byte that the layout depends on: the header and the lengths."""
    length_values: int


class _Walk:
    """Passes over a message; notes bytes without a value and those that tell its layout."""

    def __init__(self, definition: MessageDefinition, cdr: bytes) -> None:
        self._fields = definition.fields
        self._cdr = cdr
        self.at = _BODY
        self.gaps = [range(len(_HEADER), _BODY)]
        self.lengths = [range(len(_HEADER))]

    def message(self, type_name: str) -> None:
        """Pass a message; raise ValueError or struct.error where the body holds none."""
        for field in self._fields[type_name]:
            count = self._length() if field.count is None else field.count
            if field.kind in PRIMITIVES:
                self._numbers(PRIMITIVES[field.kind], count)
                continue
            for _ in range(count):
                if field.kind == STRING:
                    self._string()
                else:
                    self.message(field.kind)

    def _numbers(self, size: int, count: int) -> None:
        if count:
            start, self.at = self.at, self.at + (_BODY - self.at) % size
            self.gaps.append(range(start, self.at))
            self.at += size * count

    def _length(self) -> int:
        """Pass the length of a string or sequence and return it; raise ValueError if too long."""
        self._numbers(4, 1)
        self.lengths.append(range(self.at - 4, self.at))
        (count,) = struct.unpack_from('<I', self._cdr, self.at - 4)
        if count > len(self._cdr) - self.at:
            raise ValueError('a length runs past the end')
        return count

    def _string(self) -> None:
        """Pass a string, whose length counts the zero byte at its end."""
        count = self._length()
        self._numbers(1, count)
        if count:
            self.gaps.append(range(self.at - 1, self.at))


class CdrNormaliser:
    """Set the alignment bytes of one message type to zero and cut what follows the message."""

    def __init__(self, definition: MessageDefinition) -> None:
        self._definition = definition
        self._layouts: dict[int, list[_Layout]] = {}

    def normalise(self, cdr: bytes) -> bytes:
        """Return the message with zeros between its values; raise DdctError if it is no such."""
        value = int.from_bytes(cdr, 'little')
        known = self._layouts.setdefault(len(cdr), [])
        # Equal lengths at the same places mean the same layout, so a walk is seldom needed. With
        # a walk for each message `make bench` shows 2.5 for one process, not 1.6.
        for layout in known:
            if value & layout.lengths == layout.length_values:
                break
        else:
            layout = self._layout(cdr)
            known.insert(0, layout)
            del known[_LAYOUTS_KEPT:]
        return (value & layout.keep).to_bytes(layout.size, 'little')

    def _layout(self, cdr: bytes) -> _Layout:
        type_name = self._definition.type_name
        walk = _Walk(self._definition, cdr)
        try:
            if cdr[: len(_HEADER)] != _HEADER:
                raise ValueError('not little-endian CDR')
            walk.message(type_name)
            if walk.at > len(cdr):
                raise ValueError('it is cut short')
        except struct.error as error:
            raise DdctError(f'a message is no {type_name}: it is cut short') from error
        except ValueError as error:
            raise DdctError(f'a message is no {type_name}: {error}') from error
        depends = _ones(walk.at, walk.lengths)
        keep = _ones(walk.at, [range(walk.at)]) & ~_ones(walk.at, walk.gaps)
        return _Layout(walk.at, keep, depends, int.from_bytes(cdr, 'little') & depends)


def _ones(size: int, places: Sequence[range]) -> int:
    """Return the mask of `size` bytes with ones over the bytes in `places`."""
    mask = bytearray(size)
    for place in places:
        mask[place.start : place.stop] = b'\xff' * len(place)
    return int.from_bytes(mask, 'little')
