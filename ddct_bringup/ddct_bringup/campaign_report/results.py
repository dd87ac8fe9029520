"""The rows of a campaign: what was varied, how they are grouped, what they are judged by."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from ddct_bringup.campaign.columns import CONTROLLER
from ddct_bringup.campaign.rows import CRITERION
from ddct_bringup.campaign_report.outcome import outcomes_of
from ddct_bringup.verdict.criteria import CRITERIA
from ddct_bringup.verdict.metric_figures import FURTHER, TABLE_5_1
from ddct_plant.program.table import Figure

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

    @property
    def rows(self) -> int:
        """How many runs there are."""
        return len(self.columns[CONTROLLER])

    @cached_property
    def outcomes(self) -> np.ndarray:
        """(n,) engaged, failed or invalid."""
        return outcomes_of(self.columns['valid'], self.columns['verdict_state'])

    @cached_property
    def quantities(self) -> list[Figure]:
        """What a campaign is judged by, as far as a run has a value."""
        return [
            each
            for each in QUANTITIES
            if each.key in self.columns and not np.isnan(self.columns[each.key]).all()
        ]

    @cached_property
    def numbers(self) -> list[str]:
        """What was varied and is a number, in more than one value; of the grid first."""
        return [
            key
            for key in dict.fromkeys([*self.grid, *self.random])
            if is_number(self.columns[key]) and len(np.unique(self.columns[key])) > 1
        ]

    @cached_property
    def groups(self) -> list['Group']:
        """The runs by controller, and by all else that varies and is no number."""
        named = [key for key in (*self.grid, *self.random) if not is_number(self.columns[key])]
        keys = [CONTROLLER, *(key for key in named if len(set(self.columns[key].tolist())) > 1)]
        return [
            Group({key: str(self.columns[key][rows[0]]) for key in keys}, rows)
            for rows in self.alike(np.arange(self.rows), keys)
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
        Return where the way out of a varied number starts: at its nominal value.

        On a grid it is the value of the grid nearest to that, the lower of two. Where the scenario
        has no such number, as without an optional part, zero stands for it.
        """
        nominal = self.nominal.get(key, 0.0)
        if key not in self.grid:
            return nominal
        values = np.unique(self.columns[key])
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
    def label(self) -> str:
        """What a table calls it."""
        return ', '.join(self.names.values())


def is_number(column: np.ndarray) -> bool:
    """Say whether a column holds numbers; those that say yes or no are none."""
    return bool(np.issubdtype(column.dtype, np.number))
