"""The rows of a campaign: what was varied, how they are grouped, what they are judged by."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations
from typing import Any

import numpy as np

from ddct_bringup.campaign.columns import CONTROLLER, INDEX, SEED
from ddct_bringup.campaign.rows import CRITERION
from ddct_bringup.campaign_report.outcome import outcomes_of
from ddct_bringup.verdict.criteria import CRITERIA
from ddct_bringup.verdict.metric_figures import FURTHER, TABLE_5_1
from ddct_plant.program.table import Quantity

_NOT_JUDGED = ('steps',)
"""Of the metrics more of these is not worse."""
QUANTITIES = (
    *(figure for figure in (*TABLE_5_1, *FURTHER) if figure.key not in _NOT_JUDGED),
    *(
        replace(criterion, key=f'{CRITERION}{criterion.key}')
        for criterion in CRITERIA
        if not criterion.metric
    ),
)
"""The metrics and the other criteria, by their columns. Less of a magnitude is better for each."""


@dataclass(frozen=True)
class OtherVersion:
    """How results differ from those that this version writes; all empty where they do not."""

    absent: tuple[str, ...] = ()
    """Columns that they lack."""
    unknown: tuple[str, ...] = ()
    """Columns that this version does not know."""
    no_nominal: str = ''
    """Why the nominal values of what was varied are not known."""


@dataclass(frozen=True)
class Results:
    """The columns of `results.parquet`, and what the manifest says of them."""

    columns: Mapping[str, np.ndarray]
    """(n,) each, n >= 1, by name; NaN for a number that is not defined."""
    grid: Sequence[str]
    """Names of what was varied on a grid."""
    random: Sequence[str]
    """Names of what was drawn at random."""
    nominal: Mapping[str, float]
    """The numbers of the scenario before it was varied, as far as it has them."""
    other: OtherVersion = OtherVersion()

    @property
    def rows(self) -> int:
        """How many runs there are."""
        return len(self.columns[CONTROLLER])

    @cached_property
    def outcomes(self) -> np.ndarray:
        """(n,) what each run came to."""
        return outcomes_of(self.columns['valid'], self.columns['verdict_state'])

    @cached_property
    def quantities(self) -> list[Quantity]:
        """What a campaign is judged by, as far as a run has a value."""
        return [
            each
            for each in QUANTITIES
            if is_number(self.columns.get(each.key)) and self._defined(each.key)
        ]

    def _defined(self, key: str) -> bool:
        return not np.isnan(self.columns[key]).all()

    @cached_property
    def cases(self) -> np.ndarray:
        """(n,) which case each run has: all controllers have the same ones."""
        per_controller = self.rows // len(set(self.columns[CONTROLLER].tolist()))
        return self.columns[INDEX] % per_controller

    @cached_property
    def numbers(self) -> list[str]:
        """
        What was varied and is a number, in more than one value; of the grid first.

        A seed is none: one that is larger is no more of anything.
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
        """The numbers along which failure has a boundary: those of a grid with nothing random."""
        random = [key for key in self.random if len(set(self.columns[key].tolist())) > 1]
        return [] if random else [key for key in self.numbers if key in self.grid]

    @cached_property
    def groups(self) -> list['Group']:
        """The runs by controller, and by all else that varies and is no number."""
        varied = (*self.grid, *self.random)
        named = [key for key in varied if not is_number(self.columns[key])]
        keys = [CONTROLLER, *(key for key in named if len(set(self.columns[key].tolist())) > 1)]
        return [
            Group({key: str(self.columns[key][rows[0]]) for key in keys}, rows)
            for rows in self.alike(np.arange(self.rows), keys)
        ]

    @cached_property
    def pairs(self) -> list[tuple['Group', 'Group']]:
        """All pairs of controllers, with the cases that both have in one order."""
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
        """Return rows in parts, each of those with the same values of keys."""
        found: dict[tuple[Any, ...], list[int]] = {}
        values = zip(*(self.columns[key][rows].tolist() for key in keys), strict=True)
        for row, of_row in zip(rows, values, strict=True):
            found.setdefault(of_row, []).append(row)
        return [np.array(each) for each in found.values()]

    def is_sample(self, group: 'Group') -> bool:
        """Say whether the runs of a group differ by what was drawn at random alone."""
        on_grid = [key for key in self.numbers if key in self.grid]
        constant = all(len(np.unique(self.columns[key][group.rows])) == 1 for key in on_grid)
        return bool(self.random) and constant

    def start_of(self, key: str) -> float:
        """
        Return where the line over a number of the grid starts.

        It is the value nearest to the nominal one, the lower of two. Where the scenario
        has no such number, as without an optional part, zero stands for it. Where nominal values
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
    """Runs that are counted together."""

    names: Mapping[str, str]
    """The controller, and what else tells the groups apart."""
    rows: np.ndarray
    """(m,) positions in the columns."""

    @property
    def varied(self) -> dict[str, str]:
        """What tells it apart besides the controller."""
        return {key: name for key, name in self.names.items() if key != CONTROLLER}

    @property
    def label(self) -> str:
        """What a table calls it."""
        return ', '.join(self.names.values())


def is_number(column: np.ndarray | None) -> bool:
    """Return whether there is a column and it holds numbers; booleans are none."""
    return column is not None and bool(np.issubdtype(column.dtype, np.number))
