# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Values of one topic of a bag, added message by message and kept as columns."""

from array import array
from collections.abc import Sequence
from typing import Any

import numpy as np

from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import PERIOD_NS, START_NS
from ddct_plant.signals.signal import Signal

Column = np.ndarray | tuple[object, ...]
"""Values of a signal by stamp: numbers, or texts and events."""


class TopicValues:
    """
    Values of the signals of a topic, one row per message.

    Numbers take 8 bytes each, so that a long run takes no more memory while it is read than
    afterwards.
    """

    def __init__(self, name: str, signals: Sequence[Signal]) -> None:
        """Begin without a message; `name` is that of the topic in errors."""
        self._name = name
        self._signals = signals
        self._columns: list[Any] = [array('d') if each.unit else [] for each in signals]
        self._sizes: list[int | None] = []
        self.stamps = array('q')
        """Stamps of the messages in ns, in the order of the bag."""

    def add(self, stamp: int, row: Sequence[Any]) -> None:
        """Add the values in a message; raise DdctError where other messages have others."""
        sizes = self._require_same(row)
        self.stamps.append(stamp)
        for signal, column, values, size in zip(
            self._signals, self._columns, row, sizes, strict=True
        ):
            if not signal.unit or size is None:
                column.append(values)
            else:
                column.extend(values)

    def add_columns(self, stamps: np.ndarray, row: Sequence[Any]) -> None:
        """Add the (n,) numbers in n messages, or rows of such; raise DdctError as `add`."""
        sizes = self._require_same(row)
        self.stamps.frombytes(stamps.astype(np.int64).tobytes())
        for column, values, size in zip(self._columns, row, sizes, strict=True):
            numbers = values if size is None else np.array(values).T
            column.frombytes(numbers.astype(np.float64).tobytes())

    def _require_same(self, row: Sequence[Any]) -> list[int | None]:
        """Return the size of each value, None for a number; raise DdctError for other sizes."""
        if len(row) != len(self._signals):
            raise DdctError(
                f'{self._name}: a message has {len(row)} values, not the {len(self._signals)} of '
                'such a run',
                key=self._name,
            )
        sizes = [len(each) if isinstance(each, Sequence) else None for each in row]
        self._sizes = self._sizes or sizes
        for signal, size, first in zip(self._signals, sizes, self._sizes, strict=True):
            if signal.unit and size != first:
                raise DdctError(
                    f'{signal.name} does not have the same size at every stamp', key=self._name
                )
        return sizes

    def at_ticks(self, last: int) -> tuple[dict[str, Column], int]:
        """
        Return the columns at t_0..t_N by signal, and the number of these stamps without a message.

        A column has (N+1,) or (N+1, n) numbers, or N + 1 other values. A stamp without a message
        repeats the last one before; before the first message, the first.
        """
        rows, missing = self._rows(last)
        columns: dict[str, Column] = {}
        for signal, column, size in zip(self._signals, self._columns, self._sizes, strict=True):
            if not signal.unit:
                columns[signal.name] = tuple(column[row] for row in rows)
                continue
            values = np.frombuffer(column) if column else np.zeros(0)
            shape = (len(self.stamps),) if size is None else (len(self.stamps), size)
            columns[signal.name] = values.reshape(shape)[rows]
        return columns, missing

    def _rows(self, last: int) -> tuple[np.ndarray, int]:
        """Return the index of the message at each of t_0..t_N, and how many have none."""
        stamps = np.frombuffer(self.stamps, dtype=np.int64)
        steps, rest = np.divmod(stamps - START_NS, PERIOD_NS)
        at_tick = np.flatnonzero((rest == 0) & (steps >= 0) & (steps <= last))
        index = np.full(last + 1, -1)
        index[steps[at_tick]] = at_tick
        known = np.where(index >= 0, np.arange(last + 1), -1)
        before = np.maximum.accumulate(known)
        rows = np.where(before >= 0, index[before], int(np.argmin(stamps)))
        return rows, int(np.count_nonzero(index < 0))
