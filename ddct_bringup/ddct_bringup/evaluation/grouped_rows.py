# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rows of runs in groups: what was varied, and the nominal case."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import combinations

import numpy as np
import pyarrow as pa

from ddct_bringup.campaign.arrow_columns import numpy_columns
from ddct_bringup.campaign.rows import CONTROLLER, INDEX, SEED, STATE
from ddct_bringup.evaluation.case_figures import CaseFigures
from ddct_bringup.evaluation.quantities import QUANTITIES, is_number, with_sums
from ddct_bringup.evaluation.share import FAILED, outcomes_of
from ddct_bringup.evaluation.summary import OtherVersion
from ddct_bringup.verdict.state import ENGAGED, INVALID
from ddct_plant.program.table import Quantity


@dataclass(frozen=True)
class By:
    """
    What was varied in runs, by which their rows are grouped, and what is summarised of them.

    The runs of a group have one controller, and one value of each varied key that is no number.
    """

    grid: tuple[str, ...] = ()
    """Names of the keys varied on a grid."""
    random: tuple[str, ...] = ()
    """Names of the keys drawn at random."""
    nominal: Mapping[str, float] = field(default_factory=dict)
    """Numbers of the scenario before they were varied, where it has them."""
    other_version: OtherVersion = OtherVersion()
    parts: str | None = None
    """Key whose names are parts of a group, and make no groups of their own."""
    invalid_fails: bool = False
    """Whether an invalid run is a failure; else it does not count."""
    dominance: bool = False
    """Whether controllers are compared by the five figures."""
    focus: tuple[str, ...] | None = None
    """
    Controllers whose differences, causes of failure and figures in the parts are wanted.

    None for all.
    """


@dataclass(frozen=True, eq=False)
class GroupedRows:
    """Rows of runs with what was varied; all controllers have the same cases."""

    table: pa.Table
    """Row for each run, at least one, with the columns of a campaign."""
    by: By

    @cached_property
    def columns(self) -> Mapping[str, np.ndarray]:
        """Columns by name, (n,) each; NaN for an undefined number."""
        return with_sums(numpy_columns(self.table))

    @property
    def rows(self) -> int:
        """Number of runs."""
        return len(self.table)

    @cached_property
    def outcomes(self) -> np.ndarray:
        """Outcome of each run, (n,)."""
        return outcomes_of(self.columns['valid'], self.columns[STATE])

    @cached_property
    def failed(self) -> np.ndarray:
        """Whether each run is a failure, (n,)."""
        failed = self.outcomes == FAILED
        return failed | (self.outcomes == INVALID) if self.by.invalid_fails else failed

    @cached_property
    def quantities(self) -> list[Quantity]:
        """Evaluated quantities for which at least one run has a value."""
        return [
            each
            for each in QUANTITIES.values()
            if is_number(self.columns.get(each.key)) and not np.isnan(self.columns[each.key]).all()
        ]

    @cached_property
    def cases(self) -> np.ndarray:
        """Case of each run, (n,)."""
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
            for key in dict.fromkeys([*self.by.grid, *self.by.random])
            if key != SEED
            and is_number(self.columns[key])
            and len(np.unique(self.columns[key])) > 1
        ]

    @property
    def lines(self) -> list[str]:
        """Numbers along which failure has a boundary: those of a grid without random keys."""
        random = [key for key in self.by.random if len(set(self.columns[key].tolist())) > 1]
        return [] if random else [key for key in self.numbers if key in self.by.grid]

    @cached_property
    def groups(self) -> list['Group']:
        """Runs grouped by controller, and by all other varied keys that are not numbers."""
        varied = (*self.by.grid, *self.by.random)
        named = [
            key for key in varied if key != self.by.parts and not is_number(self.columns[key])
        ]
        keys = [CONTROLLER, *(key for key in named if len(set(self.columns[key].tolist())) > 1)]
        return [
            Group({key: str(self.columns[key][rows[0]]) for key in keys}, rows)
            for rows in self.alike(np.arange(self.rows), keys)
        ]

    @cached_property
    def pairs(self) -> list[tuple['Group', 'Group']]:
        """Pairs of controllers, with the cases of both in one order."""
        groups, focus = self.groups, self.by.focus
        pairs = (
            combinations(groups, 2)
            if focus is None
            else (
                (first, second)
                for first in groups
                for second in groups
                if first.controller in focus and second is not first
            )
        )
        return [
            (Group(first.names, first.rows[ours]), Group(second.names, second.rows[theirs]))
            for first, second in pairs
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
        on_grid = [key for key in self.numbers if key in self.by.grid]
        constant = all(len(np.unique(self.columns[key][group.rows])) == 1 for key in on_grid)
        return bool(self.by.random) and constant

    def case_figures(self, group: 'Group') -> CaseFigures:
        """Return the successes and the five figures of the runs of a group."""
        rows = group.rows
        columns = {name: column[rows] for name, column in self.columns.items()}
        return CaseFigures.of(self.outcomes[rows] == ENGAGED, columns)

    def start_of(self, key: str) -> float:
        """
        Return the start of the line over a number of the grid.

        It is the value nearest to the nominal one, the lower of two. Where the scenario has no
        such number, as without an optional part, the nominal value is zero. Where nominal values
        are not known, it is the middle of the grid.
        """
        values = np.unique(self.columns[key])
        unknown = self.by.other_version.no_nominal
        unnamed = float(values[(len(values) - 1) // 2]) if unknown else 0.0
        nominal = self.by.nominal.get(key, unnamed)
        return float(values[np.argmin(np.abs(values - nominal))])

    def others_nominal(self, rows: np.ndarray, keys: Sequence[str]) -> np.ndarray:
        """Return those of the rows in which the numbers of `others` are at their start."""
        kept = np.ones(len(rows), dtype=bool)
        for key in self.others(keys):
            kept &= self.columns[key][rows] == self.start_of(key)
        return rows[kept]

    def others(self, keys: Sequence[str]) -> list[str]:
        """Return the grid's numbers besides `keys`."""
        return [key for key in self.numbers if key in self.by.grid and key not in keys]


@dataclass(frozen=True)
class Group:
    """Runs that are evaluated together."""

    names: Mapping[str, str]
    """Controller and other names of the group."""
    rows: np.ndarray
    """Positions in the columns, (m,)."""

    @property
    def controller(self) -> str:
        """Name of the controller."""
        return self.names[CONTROLLER]

    @property
    def varied(self) -> dict[str, str]:
        """Names of the group besides the controller."""
        return {key: name for key, name in self.names.items() if key != CONTROLLER}

    @property
    def label(self) -> str:
        """Label of the group in tables."""
        return ', '.join(self.names.values())
