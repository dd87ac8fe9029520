# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Files of measurement tools as tables of columns by name: CSV, MAT of version 5, MDF 4."""

from abc import ABC, abstractmethod
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path
from typing import Protocol

import numpy as np

from ddct_plant.files.csv_table import csv_header, read_csv

MAT, MDF = ('.mat',), ('.mf4', '.mdf')
LOGS = ('.csv', *MAT, *MDF)
"""Ends of the names of logs; a file with another end is read as CSV where a log is expected."""


class LogTable(Protocol):
    """Columns of a log."""

    @property
    def columns(self) -> Mapping[str, np.ndarray]:
        """Values by name, (n,); NaN where a row has none."""

    def place(self, row: int, column: str) -> str:
        """Return the place of a value for an error."""


class LogSource(ABC):
    """A file whose columns can be listed, and read by name."""

    def __init__(self, path: Path) -> None:
        """Take the file; nothing is read before it is needed."""
        self.path = path

    @abstractmethod
    def units(self) -> Mapping[str, str]:
        """Return the units that the file states, by the name of each column; '' for none."""

    @abstractmethod
    def table(
        self,
        names: Iterable[str],
        *,
        date_times: Collection[str] = (),
        optional: Collection[str] = (),
    ) -> LogTable:
        """
        Return the columns called `names`; those in `optional` may be missing.

        Those in `date_times` have dates with times. Raise DdctError that names the file for what
        cannot be read.
        """


class CsvSource(LogSource):
    """A CSV file; a unit is a part of its column's name."""

    def units(self) -> Mapping[str, str]:
        """Return the names of the header, without units."""
        return dict.fromkeys(filter(None, csv_header(self.path)), '')

    def table(
        self,
        names: Iterable[str],
        *,
        date_times: Collection[str] = (),
        optional: Collection[str] = (),
    ) -> LogTable:
        """Return the columns; `read_csv` says what is refused."""
        return read_csv(self.path, names, date_times=date_times, optional=optional)


def source_of(path: Path, bus: Path | None = None) -> LogSource:
    """Return the source of a log by the end of its name; `bus` is the DBC of an MDF file."""
    suffix = path.suffix.lower()
    if suffix in MDF:
        from ddct_bringup.logs.mdf_source import MdfSource  # late: an optional extra

        return MdfSource(path, bus)
    if suffix in MAT:
        from ddct_bringup.logs.mat_source import MatSource  # late: scipy.io

        return MatSource(path)
    return CsvSource(path)
