# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Serialise messages that differ in their stamp and in numbers alone, without ROS.

rclpy copies each field of each message to a structure of C, which is then serialised. Where all
texts and lengths stay the same, it is enough to put the numbers into the bytes of one message.
"""

import struct
from collections.abc import Callable, Sequence
from itertools import count
from typing import Any

from ddct_plant.bag_file.cdr_walk import BODY
from ddct_plant.signals.message_kind import NS_PER_S, MessageKind, Write

_STAMP = 'iI'
"""Layout of the stamp, with which the body of every type begins."""
_NUMBER = struct.Struct('<d')
_FIRST_NUMBER = 4
"""Index of the first number in the arguments of `Struct.pack`; a constant is between any two."""
_FIRST_MARKER = 1.234567890123e-300
"""Number that no message of the graph has."""


class NumberMessage:
    """The bytes of one message, into which a stamp and numbers are put."""

    def __init__(self, serialise: Callable[..., bytes], values: Sequence[Any]) -> None:
        """
        Find the place of each number in what `serialise(stamp_ns, *values)` returns.

        Each value is a number, or each is a row of them. Later values have the same lengths.
        """
        self._rows = bool(values) and _is_row(values[0])
        marked = stand_ins(values)
        cdr = serialise(0, *marked)
        places = number_places(cdr, flat(marked))
        self._order = sorted(range(len(places)), key=places.__getitem__)
        self._arguments: list[Any] = [cdr[:BODY], 0, 0]
        layout, end = [f'<{BODY}s{_STAMP}'], BODY + struct.calcsize(_STAMP)
        for place in sorted(places):
            self._arguments += [cdr[end:place], 0.0]
            layout.append(f'{place - end}sd')
            end = place + _NUMBER.size
        self._arguments.append(cdr[end:])
        self._pack = struct.Struct(''.join([*layout, f'{len(cdr) - end}s'])).pack

    def filled(self, stamp_ns: int, values: Sequence[Any]) -> bytes:
        """Return the message with a stamp in ns and values; raise ValueError for more or less."""
        numbers = self._flat(values)
        if len(numbers) != len(self._order):
            raise ValueError(f'{len(numbers)} numbers for a message of {len(self._order)}')
        arguments = self._arguments
        arguments[1], arguments[2] = divmod(stamp_ns, NS_PER_S)
        arguments[_FIRST_NUMBER::2] = [numbers[i] for i in self._order]
        return self._pack(*arguments)

    def _flat(self, values: Sequence[Any]) -> Sequence[float]:
        return [number for row in values for number in row] if self._rows else values


def message_serialiser(
    kind: MessageKind, write: Write, by_fields: Callable[[Any], bytes]
) -> Callable[..., bytes]:
    """
    Return a function `serialise(stamp_ns, *values, **options)` for messages of a kind.

    `write` fills a message, and `by_fields` serialises it. Where all values are numbers that is
    done for the first message alone: the others have as many numbers, and the same texts.
    """

    def serialise(stamp_ns: int, *values: Any, **options: Any) -> bytes:
        return by_fields(write(stamp_ns, *values, **options))

    if not kind.numbers_alone:
        return serialise
    message: NumberMessage | None = None

    def filled(stamp_ns: int, *values: Any) -> bytes:
        nonlocal message
        if message is None:
            message = NumberMessage(serialise, values)
        return message.filled(stamp_ns, values)

    return filled


def stand_ins(values: Sequence[Any]) -> list[Any]:
    """Return values with a different number, which no message has, in place of each number."""
    markers = (_FIRST_MARKER * (1 + i) for i in count())
    return [
        [next(markers) for _ in value] if _is_row(value) else next(markers) for value in values
    ]


def number_places(cdr: bytes, numbers: Sequence[float]) -> list[int]:
    """Return the place in a message of each of its numbers, which all differ."""
    return [cdr.index(_NUMBER.pack(number)) for number in numbers]


def flat(values: Sequence[Any]) -> list[float]:
    """Return the numbers in values that are numbers, or rows of them."""
    return [number for value in values for number in (value if _is_row(value) else (value,))]


def _is_row(value: Any) -> bool:
    return hasattr(value, '__len__')
