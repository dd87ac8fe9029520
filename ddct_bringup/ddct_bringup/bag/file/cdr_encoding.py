# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Serialise messages without ROS, to the bytes that ROS gives once they are normalised."""

import struct
from collections.abc import Callable, Iterable
from itertools import groupby
from operator import attrgetter
from typing import Any

from ddct_bringup.bag.file.cdr_walk import BODY, HEADER
from ddct_bringup.bag.file.message_definitions import (
    PRIMITIVES,
    STRING,
    Field,
    MessageDefinition,
)

_START = HEADER.ljust(BODY, b'\0')
_LARGEST = 8
"""Size in bytes of the largest primitive type, to which alignment repeats."""
Put = Callable[[Any, '_Body'], None]
"""Function that adds a value, or fields of a message, to a body."""


class _Body:
    """Body of a message: the format of its values for `struct`, the values, and its size."""

    __slots__ = ('format', 'size', 'values')

    def __init__(self) -> None:
        self.format = ['<']
        self.values: list[Any] = []
        self.size = 0

    def add(self, size: int, count: int, form: str, values: Iterable[Any]) -> None:
        """Add `count` items of `size` bytes each, which are the values of a format."""
        gap = -self.size % size
        self.format.append(f'{gap}x{form}')
        self.size += gap + size * count
        self.values += values

    def bytes(self) -> bytes:
        """Return the message."""
        return _START + struct.pack(''.join(self.format), *self.values)


class CdrEncoder:
    """Serialiser of the messages of one type."""

    def __init__(self, definition: MessageDefinition) -> None:
        self._fields = definition.fields
        self._put = self._message(definition.type_name)

    def __call__(self, message: Any) -> bytes:
        """Return a message as little-endian CDR; raise struct.error for values of other types."""
        body = _Body()
        self._put(message, body)
        return body.bytes()

    def _message(self, type_name: str) -> Put:
        puts: list[Put] = []
        for numbers, group in groupby(self._fields[type_name], _is_number):
            fields = [*group]
            puts += [_numbers(fields)] if numbers else [self._field(each) for each in fields]

        def put(message: Any, body: _Body) -> None:
            for each in puts:
                each(message, body)

        return put

    def _field(self, field: Field) -> Put:
        get = attrgetter(field.name)
        if field.kind in PRIMITIVES:
            every = _list_of_numbers(field.kind)
        else:
            one = _text if field.kind == STRING else self._message(field.kind)
            if not field.many:
                return lambda message, body: one(get(message), body)
            every = _list_of(one)

        def put(message: Any, body: _Body) -> None:
            values = get(message)
            if field.count is None:
                body.add(4, 1, 'I', (len(values),))
            elif field.count != len(values):
                raise struct.error(f'{field.name} has {len(values)} values, not {field.count}')
            every(values, body)

        return put


def _is_number(field: Field) -> bool:
    return field.kind in PRIMITIVES and not field.many


def _numbers(fields: list[Field]) -> Put:
    """Return a function that adds successive numbers of a message."""
    # The gaps between them depend on where the first one begins.
    forms, sizes = zip(*(_form(fields, start) for start in range(_LARGEST)), strict=True)
    gets = [attrgetter(field.name) for field in fields]

    def put(message: Any, body: _Body) -> None:
        start = body.size % _LARGEST
        body.format.append(forms[start])
        body.size += sizes[start]
        body.values += [get(message) for get in gets]

    return put


def _form(fields: list[Field], start: int) -> tuple[str, int]:
    """Return the format of successive numbers from an offset on, and their size with gaps."""
    form, at = '', start
    for field in fields:
        size, letter = PRIMITIVES[field.kind]
        form += f'{-at % size}x{letter}'
        at += -at % size + size
    return form, at - start


def _list_of_numbers(kind: str) -> Put:
    size, letter = PRIMITIVES[kind]

    def put(values: Any, body: _Body) -> None:
        if len(values):
            body.add(size, len(values), f'{len(values)}{letter}', values)

    return put


def _list_of(one: Put) -> Put:
    def put(values: Any, body: _Body) -> None:
        for value in values:
            one(value, body)

    return put


def _text(value: str, body: _Body) -> None:
    """Add a text, whose length includes the zero byte at its end."""
    data = value.encode()
    body.add(4, 1, 'I', (len(data) + 1,))
    body.add(1, len(data) + 1, f'{len(data) + 1}s', (data,))
