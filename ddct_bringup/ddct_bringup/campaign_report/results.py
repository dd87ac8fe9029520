# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rows of a campaign: varied keys, groups of runs, and the nominal case."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import numpy as np

from ddct_bringup.campaign.columns import CONTROLLER, INDEX, SEED
from ddct_bringup.campaign.rows import STATE
from ddct_bringup.campaign_report.evaluated_quantities import QUANTITIES
from ddct_bringup.campaign_report.statistics.outcome import outcomes_of
from ddct_plant.program.table import Quantity


@dataclass(frozen=True)
class OtherVersion:
    """Differences of results from those of this version; all empty where there are none."""

    absent: tuple[str, ...] = ()
    """Missing columns."""
    unknown: tuple[str, ...] = ()
    """Columns that do not exist in this version."""
    no_nominal: str = ''
    """Reason why the nominal values of the varied keys are not known."""


@dataclass(frozen=True)
class Results:
    """Columns of `results.parquet`, with the varied keys of the manifest."""

    columns: Mapping[str, np.ndarray]
    """Columns by name, (n,) each, n >= 1; NaN for an undefined number."""
    grid: Sequence[str]
    """Names of the keys varied on a grid."""
    random: Sequence[str]
    """Names of the keys drawn at random."""
    nominal: Mapping[str, float]
    """Numbers of the scenario before they were varied, where it has them."""
    other: OtherVersion = OtherVersion()

    @property
    def rows(self) -> int:
        """Number of runs."""
        return len(self.columns[CONTROLLER])

    @cached_property
    def outcomes(self) -> np.ndarray:
        """Outcome of each run, (n,)."""
        return outcomes_of(self.columns['valid'], self.columns[STATE])

    @cached_property
    def quantities(self) -> list[Quantity]:
        """Evaluated quantities for which at least one run has a value."""
        return [
            each
            for each in QUANTITIES
            if is_number(self.columns.get(each.key)) and self._defined(each.key)
        ]

    def _defined(self, key: str) -> bool:
        return not np.isnan(self.columns[key]).all()

    @cached_property
    def cases(self) -> np.ndarray:
        """Case of each run, (n,); all controllers have the same cases."""
        per_controller = self.rows // len(set(self.columns[CONTROLLER].tolist()))
        return self.columns[INDEX] % per_controller

    @cached_property
    def numbers(self) -> list[str]:
        """
        Varied keys that are numbers with more than one value; those of the grid first.

        Seeds are excluded: their size has no meaning.
        """
        return [
            key
            for key in dict.fromkeys([*self.grid, *self.random])
            if key != SEED
            and is_number(self.columns[key])
            and len(np.unique(self.columns[key])) > 1
        ]

    @property
    def lines(self) -> list[str]:
        """Numbers along which failure has a boundary: those of a grid without random keys."""
        random = [key for key in self.random if len(set(self.columns[key].tolist())) > 1]
        return [] if random else [key for key in self.numbers if key in self.grid]

    @cached_property
    def groups(self) -> list['Group']:
        """Runs grouped by controller, and by all other varied keys that are not numbers."""
        varied = (*self.grid, *self.random)
        named = [key for key in varied if not is_number(self.columns[key])]
        keys = [CONTROLLER, *(key for key in named if len(set(self.columns[key].tolist())) > 1)]
        return [
            Group({key: str(self.columns[key][rows[0]]) for key in keys}, rows)
            for rows in self.alike(np.arange(self.rows), keys)
        ]

    @cached_property
    def pairs(self) -> list[tuple['Group', 'Group']]:
        """All pairs of controllers, with the cases of both in one order."""
        return [
            (Group(first.names, first.rows[ours]), Group(second.names, second.rows[theirs]))
            for first, second in combinations(self.groups, 2)
            if first.varied == second.varied
            for _, ours, theirs in [
                np.intersect1d(
                    self.cases[first.rows], self.cases[second.rows], return_indices=True
                )
            ]
            if len(ours)
        ]

    def alike(self, rows: np.ndarray, keys: Sequence[str]) -> list[np.ndarray]:
        """Return rows in parts with equal values of the keys."""
        found: dict[tuple[object, ...], list[int]] = {}
        values = zip(*(self.columns[key][rows].tolist() for key in keys), strict=True)
        for row, of_row in zip(rows, values, strict=True):
            found.setdefault(of_row, []).append(row)
        return [np.array(each) for each in found.values()]

    def is_sample(self, group: 'Group') -> bool:
        """Return whether the runs of a group differ only by random keys."""
        on_grid = [key for key in self.numbers if key in self.grid]
        constant = all(len(np.unique(self.columns[key][group.rows])) == 1 for key in on_grid)
        return bool(self.random) and constant

    def start_of(self, key: str) -> float:
        """
        Return the start of the line over a number of the grid.

        It is the value nearest to the nominal one, the lower of two. Where the scenario has no
        such number, as without an optional part, the nominal value is zero. Where nominal values
        are not known, it is the middle of the grid.
        """
        values = np.unique(self.columns[key])
        unnamed = float(values[(len(values) - 1) // 2]) if self.other.no_nominal else 0.0
        nominal = self.nominal.get(key, unnamed)
        return float(values[np.argmin(np.abs(values - nominal))])

    def others_nominal(self, rows: np.ndarray, keys: Sequence[str]) -> np.ndarray:
        """Return those of the rows in which the numbers of `others` are at their start."""
        kept = np.ones(len(rows), dtype=bool)
        for key in self.others(keys):
            kept &= self.columns[key][rows] == self.start_of(key)
        return rows[kept]

    def others(self, keys: Sequence[str]) -> list[str]:
        """Return the grid's numbers besides `keys`."""
        return [key for key in self.numbers if key in self.grid and key not in keys]


@dataclass(frozen=True)
class Group:
    """Runs that are evaluated together."""

    names: Mapping[str, str]
    """Controller and other names of the group."""
    rows: np.ndarray
    """Positions in the columns, (m,)."""

    @property
    def varied(self) -> dict[str, str]:
        """Names of the group besides the controller."""
        return {key: name for key, name in self.names.items() if key != CONTROLLER}

    @property
    def label(self) -> str:
        """Label of the group in tables."""
        return ', '.join(self.names.values())


def is_number(column: np.ndarray | None) -> bool:
    """Return whether there is a column of numbers; booleans are none."""
    return column is not None and bool(np.issubdtype(column.dtype, np.number))
