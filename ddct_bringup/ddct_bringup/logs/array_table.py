# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Columns by name that are in memory, as the readers of binary logs give them."""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import close_name


@dataclass(frozen=True)
class ArrayTable:
    """Columns of a log."""

    path: Path
    columns: Mapping[str, np.ndarray]
    """Values by name, (n,); NaN where a row has none."""

    def place(self, row: int, column: str) -> str:
        """Return the place of a value for an error: file, row from 1 and column."""
        return f'{self.path}: row {row + 1}, column {column}'


def present(
    path: Path, names: Iterable[str], known: Collection[str], optional: Collection[str]
) -> list[str]:
    """Return the names that a file has; raise ParameterError for one that is not optional."""
    wanted = dict.fromkeys(names)
    for name in wanted:
        if name not in known and name not in optional:
            raise ParameterError(
                f'no column {name!r}: {close_name(name, known)}', key=name, place=path
            )
    return [name for name in wanted if name in known]
