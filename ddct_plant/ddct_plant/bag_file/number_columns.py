# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Serialised messages of a topic that differ in stamps and numbers alone, many at once.

Two such messages have their numbers at the same places, which one message with markers as its
numbers shows: numpy writes the numbers of a run into copies of it, or reads them out.
"""

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from ddct_plant.bag_file.cdr_numbers import flat, number_places, stand_ins
from ddct_plant.bag_file.cdr_walk import BODY
from ddct_plant.bag_file.message_definitions import encode, message_class
from ddct_plant.signals.message_kind import NS_PER_S
from ddct_plant.signals.topic import Topic

_STAMP = slice(BODY, BODY + 8)
"""Place of the stamp, with which the body of every type begins."""


class NumberColumns:
    """Places of the stamp and the numbers in the messages of a topic."""

    def __init__(self, topic: Topic, values: Sequence[Any]) -> None:
        """Find the places in messages whose values are numbers, or rows of as many numbers."""
        self._rows = [hasattr(value, '__len__') for value in values]
        sizes = [len(value) if row else 1 for value, row in zip(values, self._rows, strict=True)]
        self._ends = np.cumsum(sizes)
        marked = stand_ins(values)
        cdr = encode(topic.writer(message_class)(0, *marked))
        places = np.array(number_places(cdr, flat(marked)), dtype=int)
        self._bytes = np.add.outer(places, np.arange(8)).ravel()
        self._template = np.frombuffer(cdr, np.uint8)

    def encode(self, stamps_ns: np.ndarray, values: Sequence[np.ndarray]) -> list[bytes]:
        """Return n messages with (n,) stamps in ns and values of (n,) or (n, size) numbers."""
        messages = np.tile(self._template, (len(stamps_ns), 1))
        stamp = np.column_stack(np.divmod(stamps_ns, NS_PER_S)).astype('<u4')
        messages[:, _STAMP] = stamp.view(np.uint8)
        if values:
            numbers = np.column_stack(values).astype('<f8', copy=False)
            messages[:, self._bytes] = np.ascontiguousarray(numbers).view(np.uint8)
        return [message.tobytes() for message in messages]

    def decode(self, cdrs: Sequence[bytes]) -> tuple[np.ndarray, list[np.ndarray]] | None:
        """
        Return (n,) stamps in ns and the values of n messages, as in `encode`.

        None where anything else in them differs.
        """
        size = len(self._template)
        if any(len(cdr) != size for cdr in cdrs):
            return None
        messages = np.frombuffer(b''.join(cdrs), np.uint8).reshape(-1, size)
        if (messages[:, self._others] != self._template[self._others]).any():
            return None
        stamp = np.ascontiguousarray(messages[:, _STAMP]).view('<u4').astype(np.int64)
        numbers = np.ascontiguousarray(messages[:, self._bytes]).view('<f8')
        columns = np.split(numbers, self._ends[:-1], axis=1) if self._rows else []
        return stamp[:, 0] * NS_PER_S + stamp[:, 1], [
            column if row else column[:, 0]
            for column, row in zip(columns, self._rows, strict=True)
        ]

    @cached_property
    def _others(self) -> np.ndarray:
        """Places of the bytes that all messages share; those of the header's options do not."""
        numbers = np.concatenate([np.arange(_STAMP.start, _STAMP.stop), self._bytes])
        places = np.setdiff1d(np.arange(len(self._template)), numbers)
        return places[(places < 2) | (places >= BODY)]
