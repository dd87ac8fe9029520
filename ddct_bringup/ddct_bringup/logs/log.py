# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A log of a drive: quantities over time in SI units, from a file of a tool or from a bag."""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ddct_bringup.logs.bag_log import read_bag_signals
from ddct_bringup.logs.columns import (
    DATE_TIME,
    OWN_HELD,
    QUANTITIES,
    TIME,
    ColumnMap,
)
from ddct_bringup.logs.sources import LogTable, source_of
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.input_file import mcap_of

HIGHEST_SPEED = 1000.0
"""Highest speed in rad/s of an engine, shaft or wheel of a car; 3000 rpm read as rad/s is
higher."""
SPEEDS = ('engine_speed', 'shaft_speed', 'wheel_speed')


@dataclass(frozen=True, eq=False)
class MeasuredLog:
    """Measured quantities over time; NaN where a row has no value of a quantity."""

    path: Path
    """Path of the log."""
    digest: str
    """First 16 digits of the SHA-256 of the file."""
    time_s: np.ndarray
    """Times of the rows in s, (n,), rising."""
    signals: dict[str, np.ndarray]
    """Values in SI units, (n,), by quantity."""
    held: tuple[str, ...] = ()
    """`held` of the column map, OWN_HELD in a bag."""
    _samples: dict[str, tuple[np.ndarray, np.ndarray]] = field(
        default_factory=dict, init=False, repr=False
    )
    _usual_steps: dict[str, float] = field(default_factory=dict, init=False, repr=False)

    def samples(self, name: str) -> tuple[np.ndarray, np.ndarray]:
        """Return times in s and values of a quantity, in the rows that have it."""
        # Kept, because each of many short stretches asks for those of the whole log.
        if name not in self._samples:
            rows = np.isfinite(self.signals[name])
            self._samples[name] = self.time_s[rows], self.signals[name][rows]
        return self._samples[name]

    def usual_step(self, name: str) -> float:
        """Return the median time in s between two samples of a quantity."""
        if name not in self._usual_steps:
            self._usual_steps[name] = float(np.median(np.diff(self.samples(name)[0])))
        return self._usual_steps[name]

    def at(self, name: str, time_s: np.ndarray) -> np.ndarray:
        """Return a quantity at any times in s, interpolated linearly or held."""
        return between(*self.samples(name), time_s, held=name in self.held)

    def part(self, first: float, last: float) -> 'MeasuredLog':
        """Return the rows from one time in s to another, both included."""
        rows = (self.time_s >= first) & (self.time_s <= last)
        signals = {name: values[rows] for name, values in self.signals.items()}
        return MeasuredLog(self.path, self.digest, self.time_s[rows], signals, self.held)


def between(
    times_s: np.ndarray, values: np.ndarray, at_s: np.ndarray, *, held: bool
) -> np.ndarray:
    """Return samples (n,) at any times in s, (m,), held or linear between, constant outside."""
    if not held:
        return np.interp(at_s, times_s, values)
    # The tolerance keeps a time on a sample from falling before it by rounding.
    before = np.searchsorted(times_s, at_s + 1e-9, side='right') - 1
    return values[np.clip(before, 0, len(values) - 1)]


def read_log(path: Path, columns: ColumnMap, needed: Sequence[str] = ()) -> MeasuredLog:
    """
    Read the log of another tool with its column map, or a bag, which needs none.

    Raise DdctError for a file that cannot be read, a quantity that is missing, times that do not
    rise, and speeds that no car has, in one line with the place.
    """
    try:
        if path.suffix == '.mcap' or path.is_dir():
            bag = mcap_of(path)
            signals = read_bag_signals(bag)  # first, because it refuses what is no file
            log = MeasuredLog(path, _digest(bag), *signals, OWN_HELD)
        else:
            log = _read_mapped_log(path, columns, needed)
    except ParameterError as error:
        raise DdctError(str(error)) from error
    for name in needed:
        if not np.isfinite(log.signals[name]).any():
            raise DdctError(f'{path}: {name} has no value in any row')
    return log


def _read_mapped_log(path: Path, columns: ColumnMap, needed: Sequence[str]) -> MeasuredLog:
    if missing := [name for name in needed if name not in columns.columns]:
        added = ', '.join(f'columns.{name}' for name in missing)
        raise ParameterError(
            f'{path}: the column map has no {", ".join(missing)}: add {added}', key=added
        )
    mapped = columns.columns
    table = source_of(path, columns.bus).table(
        [name for each in mapped.values() for name in each.names],
        date_times=[n for each in mapped.values() if each.unit == DATE_TIME for n in each.names],
        optional=[n for name in columns.optional for n in mapped[name].names],
    )
    signals = {
        name: each.si_values(table.columns, QUANTITIES[name].unit)
        for name, each in mapped.items()
        if table.columns.keys() >= {*each.names}
    }
    _require_rising(table, mapped[TIME].names[0], signals[TIME])
    for name, values in signals.items():
        if QUANTITIES[name].unit == 'rad/s':
            _require_speed(table, columns, name, values)
    time_s = signals.pop(TIME)
    return MeasuredLog(path, _digest(path), time_s, signals, columns.held)


def _require_rising(table: LogTable, column: str, time_s: np.ndarray) -> None:
    missing = np.flatnonzero(~np.isfinite(time_s))
    if missing.size:
        raise ParameterError(f'{table.place(int(missing[0]), column)}: the time is empty: mend it')
    back = np.flatnonzero(np.diff(time_s) <= 0.0)
    if back.size:
        row = int(back[0]) + 1
        raise ParameterError(
            f'{table.place(row, column)}: the time goes from {time_s[row - 1]:.9g} to '
            f'{time_s[row]:.9g} s: it must rise'
        )


def _require_speed(table: LogTable, columns: ColumnMap, name: str, values: np.ndarray) -> None:
    high = np.flatnonzero(np.abs(values) > HIGHEST_SPEED)
    if high.size:
        row, column = int(high[0]), columns.columns[name]
        raise ParameterError(
            f'{table.place(row, column.names[0])}: {name} is {values[row]:g} rad/s: is it '
            f'in another unit than {column.unit}?'
        )


def _digest(path: Path) -> str:
    with path.open('rb') as file:
        return hashlib.file_digest(file, 'sha256').hexdigest()[:16]
