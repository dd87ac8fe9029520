# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Walk through a serialised message: where its values are, and how to read others like it.

Two messages of a type whose texts and lists have the same lengths have all values at the same
places, so that one walk serves both.
"""

import struct
from collections.abc import Callable, Mapping, Sequence
from operator import itemgetter
from typing import Any

from ddct_plant.bag_file.message_definitions import (
    PRIMITIVES,
    STRING,
    Field,
    MessageDefinition,
)

HEADER = b'\x00\x01'
"""First bytes of plain little-endian CDR; two option bytes follow, then the body."""
BODY = 4
"""Offset of the body, from which values are aligned."""
_BYTES = ('byte', 'uint8')
"""Types whose lists are bytes."""
Build = Callable[[list[Any]], Any]
"""Function that makes a value of a message from all numbers and texts in it."""


class Message:
    """Message whose fields are attributes; each is made when it is read, as few of them are."""

    __slots__ = ('_builds', '_values')

    def __init__(self, builds: Mapping[str, Build], values: list[Any]) -> None:
        self._builds = builds
        self._values = values

    def __getattr__(self, name: str) -> Any:
        try:
            build = self._builds[name]
        except KeyError:
            raise AttributeError(name) from None
        return build(self._values)


class Walk:
    """Walk through one message: the bytes without a value, and those that decide the places."""

    def __init__(self, definition: MessageDefinition, cdr: bytes) -> None:
        """Walk; raise ValueError or struct.error where the bytes are no message of this type."""
        self._fields = definition.fields
        self._cdr = cdr
        self._format = ['<']
        self._values = 0
        self._texts: list[int] = []
        self.size = BODY
        """Number of bytes of the message, without those behind its end."""
        self.gaps = [range(len(HEADER), BODY)]
        """Bytes without a value."""
        self.lengths = [range(len(HEADER))]
        """Bytes of the header and of the lengths."""
        self._build = self._message(definition.type_name)
        if self.size > len(cdr):
            raise ValueError('it is cut short')
        self._unpack = struct.Struct(''.join(self._format)).unpack_from

    def message(self, cdr: bytes) -> Any:
        """
        Return the message in other bytes with values at the same places.

        Raise UnicodeDecodeError for a text that is none.
        """
        values = list(self._unpack(cdr, BODY))
        for place in self._texts:
            values[place] = values[place].decode()
        return self._build(values)

    def _message(self, type_name: str) -> Build:
        builds = {field.name: self._field(field) for field in self._fields[type_name]}
        return lambda values: Message(builds, values)

    def _field(self, field: Field) -> Build:
        count = self._length() if field.count is None else field.count
        if field.kind in PRIMITIVES:
            return self._primitives(field, count)
        one = self._string if field.kind == STRING else lambda: self._message(field.kind)
        builds = [one() for _ in range(count)]
        return _list_of(builds) if field.many else builds[0]

    def _primitives(self, field: Field, count: int) -> Build:
        size, letter = PRIMITIVES[field.kind]
        first = self._values
        if field.many and field.kind in _BYTES:
            self._take(1, count, f'{count}s', 1)
            return itemgetter(first)
        self._take(size, count, f'{count}{letter}', count)
        if not field.many:
            return itemgetter(first)
        return itemgetter(slice(first, first + count))

    def _take(self, size: int, count: int, form: str, values: int) -> None:
        """Pass `count` items of `size` bytes, which are `values` values of the format `form`."""
        if count:
            start, self.size = self.size, self.size + (BODY - self.size) % size
            self.gaps.append(range(start, self.size))
            self._format.append(f'{self.size - start}x')
            self.size += size * count
        self._format.append(form)
        self._values += values

    def _length(self) -> int:
        """Return the length of a text or list; raise ValueError if it is too long."""
        self._take(4, 1, '4x', 0)
        self.lengths.append(range(self.size - 4, self.size))
        (count,) = struct.unpack_from('<I', self._cdr, self.size - 4)
        if count > len(self._cdr) - self.size:
            raise ValueError('a length runs past the end')
        return count

    def _string(self) -> Build:
        """Pass a text, whose length includes the zero byte at its end."""
        count, place = self._length(), self._values
        self._texts.append(place)
        self._take(1, count, f'{count - 1}sx' if count else '0s', 1)
        if count:
            self.gaps.append(range(self.size - 1, self.size))
        return itemgetter(place)


def _list_of(builds: Sequence[Build]) -> Build:
    return lambda values: [build(values) for build in builds]
