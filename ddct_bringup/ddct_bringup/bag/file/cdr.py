"""
Make serialised messages reproducible to the byte.

CDR aligns numbers with bytes that the ROS serialiser leaves as it finds them in memory, and
`rclpy.serialization` may also leave such bytes behind the end. Both would differ from run to run.
"""

import struct
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ddct_bringup.bag.file.message_definitions import MessageDefinition
from ddct_plant.base.errors import DdctError

_HEADER = b'\x00\x01'
"""First bytes of plain little-endian CDR; two option bytes follow, then the body."""
_BODY = 4

_LAYOUTS_KEPT = 32
"""Layouts remembered per message size; numbers written as text have a few lengths each."""

_NESTED = 1
_STRING = 17
_SIZES = {2: 1, 3: 1, 4: 2, 5: 2, 6: 4, 7: 4, 8: 8, 9: 8, 10: 4, 11: 8, 13: 1, 15: 1, 16: 1}
"""Size of each primitive by its number in type_description_interfaces/msg/FieldType."""
_SHAPE = 48
"""Added to a primitive's number once for an array, more often for kinds of sequences."""
_ARRAY = 1


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
    """A position in a message body that notes the bytes it passes over."""

    def __init__(self, body: memoryview) -> None:
        self._body = body
        self.at = 0
        self.gaps: list[range] = []
        self.lengths: list[int] = []

    def numbers(self, size: int, count: int) -> None:
        """Pass `count` numbers of `size` bytes."""
        if count:
            start, self.at = self.at, self.at + -self.at % size
            if self.at > start:
                self.gaps.append(range(start, self.at))
            self.at += size * count

    def length(self) -> int:
        """Pass the length of a string or sequence and return it; raise ValueError if too long."""
        self.numbers(4, 1)
        self.lengths.append(self.at - 4)
        (count,) = struct.unpack_from('<I', self._body, self.at - 4)
        if count > len(self._body) - self.at:
            raise ValueError('a length runs past the end')
        return count

    def string(self) -> None:
        """Pass a string, whose length counts the zero byte at its end."""
        count = self.length()
        self.numbers(1, count)
        if count:
            self.gaps.append(range(self.at - 1, self.at))


_Step = Callable[[_Walk], None]


class CdrNormaliser:
    """Set the alignment bytes of one message type to zero and cut what follows the message."""

    def __init__(self, definition: MessageDefinition) -> None:
        """Raise DdctError for a type with fields that this reader does not know."""
        self._type_name = definition.type_name
        self._walk = _struct(definition, definition.type_name)
        self._layouts: dict[int, list[_Layout]] = {}

    def normalise(self, cdr: bytes) -> bytes:
        """Return the message with zeros between its values; raise DdctError if it is no such."""
        value = int.from_bytes(cdr, 'little')
        known = self._layouts.setdefault(len(cdr), [])
        # Equal lengths at the same places mean the same layout, so a walk is seldom needed.
        for layout in known:
            if value & layout.lengths == layout.length_values:
                break
        else:
            layout = self._layout(cdr)
            known.insert(0, layout)
            del known[_LAYOUTS_KEPT:]
        return (value & layout.keep).to_bytes(layout.size, 'little')

    def _layout(self, cdr: bytes) -> _Layout:
        walk = _Walk(memoryview(cdr)[_BODY:])
        try:
            if cdr[: len(_HEADER)] != _HEADER:
                raise ValueError('not little-endian CDR')
            self._walk(walk)
            if _BODY + walk.at > len(cdr):
                raise ValueError('it is cut short')
        except struct.error as error:
            raise DdctError(f'a message is no {self._type_name}: it is cut short') from error
        except ValueError as error:
            raise DdctError(f'a message is no {self._type_name}: {error}') from error
        keep = bytearray(b'\xff' * (_BODY + walk.at))
        keep[len(_HEADER) : _BODY] = bytes(_BODY - len(_HEADER))
        for gap in walk.gaps:
            keep[_BODY + gap.start : _BODY + gap.stop] = bytes(len(gap))
        lengths = bytearray(len(keep))
        lengths[: len(_HEADER)] = b'\xff' * len(_HEADER)
        for at in walk.lengths:
            lengths[_BODY + at : _BODY + at + 4] = b'\xff' * 4
        mask = int.from_bytes(lengths, 'little')
        return _Layout(
            len(keep), int.from_bytes(keep, 'little'), mask, int.from_bytes(cdr, 'little') & mask
        )


def _struct(definition: MessageDefinition, type_name: str) -> _Step:
    steps = [_field(definition, field['type']) for field in definition.fields[type_name]]

    def walk(at: _Walk) -> None:
        for step in steps:
            step(at)

    return walk


def _field(definition: MessageDefinition, field: dict[str, Any]) -> _Step:
    shape, element = divmod(field['type_id'], _SHAPE)
    capacity = field['capacity']
    if element in _SIZES:
        size = _SIZES[element]
        if shape == _ARRAY:
            return lambda at: at.numbers(size, capacity)
        if shape:
            return lambda at: at.numbers(size, at.length())
        return lambda at: at.numbers(size, 1)
    if element == _NESTED:
        step = _struct(definition, field['nested_type_name'])
    elif element == _STRING:
        step = _Walk.string
    else:
        raise DdctError(f'{definition.type_name}: field type {field["type_id"]} is not supported')
    if shape == _ARRAY:
        return lambda at: _repeat(step, at, capacity)
    return (lambda at: _repeat(step, at, at.length())) if shape else step


def _repeat(step: _Step, at: _Walk, count: int) -> None:
    for _ in range(count):
        step(at)
