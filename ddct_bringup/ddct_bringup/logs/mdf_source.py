# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""An MDF 4 file as a log, read by asammdf where the user has installed it: channels or a bus."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from ddct_bringup.logs.array_table import ArrayTable, present
from ddct_bringup.logs.sources import LogSource, LogTable
from ddct_plant.base.errors import FOREIGN_FAILURES, DdctError, ParameterError

TIMESTAMPS = 'timestamps'
"""Name of the column with the times of all channels, in s."""


class MdfSource(LogSource):
    """
    Channels of an MDF file, or the signals of the frames of a bus in it by a DBC file.

    Each channel has its own times. The rows of a table are all of them, in the column
    `timestamps`; a channel has a value in its own rows.
    """

    def __init__(self, path: Path, bus: Path | None) -> None:
        """Take the file and the DBC file, None where channels are read."""
        super().__init__(path)
        self._bus = bus

    def units(self) -> Mapping[str, str]:
        """Return the units of the channels."""
        with self._opened() as file:
            found = {
                name: file.get_channel_unit(name, *places[0]) or ''
                for name, places in _channels(file).items()
            }
        return {TIMESTAMPS: 's', **found}

    def table(
        self,
        names: Iterable[str],
        *,
        date_times: Collection[str] = (),
        optional: Collection[str] = (),
    ) -> LogTable:
        """Return channels on all their times; raise DdctError for one without numbers."""
        if date_times:
            raise ParameterError(
                f'an MDF file has no dates with times: time is {{column: {TIMESTAMPS}, unit: s}}',
                place=self.path,
            )
        with self._opened() as file:
            channels = _channels(file)
            known = [TIMESTAMPS, *channels]
            found = [
                name for name in present(self.path, names, known, optional) if name != TIMESTAMPS
            ]
            signals = {name: self._samples(file, name, channels[name]) for name in found}
        times = np.unique(np.concatenate([np.zeros(0), *(each for each, _ in signals.values())]))
        columns = {TIMESTAMPS: times}
        for name, (of_name, values) in signals.items():
            columns[name] = np.full(len(times), np.nan)
            columns[name][np.searchsorted(times, of_name)] = values
        return ArrayTable(self.path, columns)

    def _samples(
        self, file: Any, name: str, places: Sequence[tuple[int, int]]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return times in s and values of a channel; the last of values at one time counts."""
        if len(places) > 1:
            raise ParameterError(
                f'the channel {name!r} is there {len(places)} times: keep one of them in the file',
                key=name,
                place=self.path,
            )
        signal = file.get(name, *places[0])
        if signal.samples.dtype.kind not in 'biuf' or signal.samples.ndim != 1:
            raise ParameterError(
                f'the channel {name!r} has no numbers: choose another', key=name, place=self.path
            )
        return np.asarray(signal.timestamps), signal.samples.astype(float)

    @contextmanager
    def _opened(self) -> Iterator[Any]:
        """Yield the file, or the signals of its bus; raise DdctError for what cannot be read."""
        try:
            from asammdf import MDF
        except ImportError as error:
            raise DdctError(
                'an MDF file needs asammdf, which is missing: pip install asammdf',
                place=self.path,
            ) from error
        for path in filter(None, (self.path, self._bus)):
            if not path.is_file():
                raise DdctError('no such file', place=path)
        try:
            with MDF(self.path) as file:
                if self._bus is None:
                    yield file
                else:
                    with file.extract_bus_logging({'CAN': [(str(self._bus), 0)]}) as signals:
                        yield signals
        except DdctError:
            raise
        except FOREIGN_FAILURES as error:  # of a damaged file asammdf raises many kinds
            by = f' by {self._bus}' if self._bus else ''
            raise DdctError(
                f'asammdf cannot read it{by} ({type(error).__name__}: {error}): give another file',
                place=self.path,
            ) from error


def _channels(file: Any) -> dict[str, list[tuple[int, int]]]:
    """Return the places, group and index, of each channel that is no time, by its own name."""
    found: dict[str, list[tuple[int, int]]] = {}
    for number, group in enumerate(file.groups):
        for index, channel in enumerate(group.channels):
            if file.masters_db.get(number) != index:
                found.setdefault(channel.name, []).append((number, index))
    return found
