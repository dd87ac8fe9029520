# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Objectives and constraints: a quantity of the runs or the loop, and what is wanted of it."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np
import pyarrow as pa

from ddct_bringup.campaign.arrow_columns import numpy_column
from ddct_bringup.campaign.rows import STATE
from ddct_bringup.campaign.specification.parts import mapping_of
from ddct_bringup.evaluation.quantities import OF_RUNS
from ddct_plant.base.errors import ParameterError, require_choice, require_number
from ddct_plant.base.options import require_known
from ddct_plant.program.table import PURE, Quantity

OBJECTIVES, CONSTRAINTS = 'objectives', 'constraints'
ENGAGED = 'engaged'
UNSTABLE_CORNERS, SENSITIVITY_PEAK = 'unstable_corners', 'corner_sensitivity_peak'
UPDATE_TIME = 'update_time_over_pi'
OF_LOOP = (UNSTABLE_CORNERS, SENSITIVITY_PEAK)
"""Quantities of the sampled loop of a linear controller, known before any run."""
_OTHERS = (
    Quantity(ENGAGED, 'engaged', PURE, '.3f', 'share of all runs that engage'),
    Quantity(UNSTABLE_CORNERS, 'unstable corners', PURE, '.0f', 'corners with an unstable loop'),
    Quantity(SENSITIVITY_PEAK, 'corner M_s', PURE, '.2f', 'largest M_s over all corners'),
    Quantity(
        UPDATE_TIME, 'update time over pi', PURE, '.2f', 'median update time over that of pi'
    ),
)
KNOWN: Mapping[str, Quantity] = {each.key: each for each in (*OF_RUNS.values(), *_OTHERS)}
"""Quantities that can be an objective or a constraint, by key."""
MINIMISE: Final = 'minimise'
MAXIMISE: Final = 'maximise'
_STATISTIC, _DIRECTION = 'statistic', 'direction'
_QUANTILES = {'p5': 0.05, 'median': 0.5, 'p95': 0.95}
STATISTICS = ('mean', *_QUANTILES, 'worst')
"""Statistics of a quantity over the engaged runs."""
AT_MOST, AT_LEAST = 'at_most', 'at_least'
Sense = Literal['minimise', 'maximise']


@dataclass(frozen=True)
class RunColumns:
    """What the goals need of the runs of one trial so far."""

    engaged: np.ndarray
    """Whether each run engaged, (n,)."""
    values: Mapping[str, np.ndarray]
    """Magnitudes by quantity, (n,) each; NaN for an undefined one."""
    left: int
    """Number of runs that were not computed."""

    @classmethod
    def of(cls, rows: pa.Table, goals: Iterable['Goal'], left: int) -> 'RunColumns':
        """Return the columns of rows of a campaign."""
        names = {goal.name for goal in goals if goal.of_runs and goal.name != ENGAGED}
        if not len(rows):
            return cls(np.empty(0, dtype=bool), dict.fromkeys(names, np.empty(0)), left)
        values = {name: np.abs(numpy_column(rows[name]).astype(float)) for name in names}
        return cls(numpy_column(rows[STATE]) == ENGAGED, values, left)


@dataclass(frozen=True)
class Goal:
    """One quantity, its statistic over the engaged runs, and the direction that is better."""

    name: str
    statistic: str
    """One of STATISTICS; empty for a quantity of the trial and not of each run."""
    sense: Sense

    @property
    def quantity(self) -> Quantity:
        """Symbol, unit and format."""
        return KNOWN[self.name]

    @property
    def of_runs(self) -> bool:
        """Whether it follows from the runs alone."""
        return self.name not in (*OF_LOOP, UPDATE_TIME)

    @property
    def title(self) -> str:
        """Name with its statistic."""
        return f'{self.statistic} {self.quantity.symbol}'.strip()

    def value(self, columns: RunColumns) -> float | None:
        """
        Return the best value that is still possible; the value itself where no run is left.

        Where runs are left, each of them engages and has the best magnitude, which is zero where
        less is better. A statistic over more runs with such values is never worse, so a bound that
        breaks a constraint proves that the whole trial does. None where no run has a value.
        """
        if self.name == ENGAGED:
            return float((columns.engaged.sum() + columns.left) / self._runs(columns))
        taken = columns.values[self.name][columns.engaged]
        taken = taken[~np.isnan(taken)]
        return self._statistic(np.append(taken, np.full(columns.left, self._best)))

    def _runs(self, columns: RunColumns) -> int:
        return len(columns.engaged) + columns.left

    @property
    def _best(self) -> float:
        return 0.0 if self.sense == MINIMISE else np.inf

    def _statistic(self, values: np.ndarray) -> float | None:
        if not len(values):
            return None
        if self.statistic == 'mean':
            return float(np.mean(values))
        if self.statistic == 'worst':
            return float(np.max(values) if self.sense == MINIMISE else np.min(values))
        with np.errstate(invalid='ignore'):
            found = float(np.quantile(values, _QUANTILES[self.statistic]))
        return self._best if np.isnan(found) else found


@dataclass(frozen=True)
class Constraint:
    """A goal with a limit, which every result must keep."""

    goal: Goal
    limit: float

    @property
    def title(self) -> str:
        """Name with statistic and limit."""
        word = 'at most' if self.goal.sense == MINIMISE else 'at least'
        return f'{self.goal.title} {word} {self.limit:g}'

    def violation(self, value: float | None) -> float:
        """Return how far a value is beyond the limit, in parts of it; at most 0 where it keeps."""
        if value is None:
            return 1.0
        over = value - self.limit if self.goal.sense == MINIMISE else self.limit - value
        return over / max(abs(self.limit), 1.0)

    def breaks(self, value: float | None) -> bool:
        """Return whether a value, or the best one that is still possible, breaks the limit."""
        return self.violation(value) > 0.0


def objectives_of(content: Any) -> tuple[Goal, ...]:
    """Return the objectives of a specification; raise ParameterError that names the key."""
    given = _named(OBJECTIVES, content)
    goals = []
    for name, described in given.items():
        where = f'{OBJECTIVES}.{name}'
        keys = mapping_of(where, described or {}, (_STATISTIC, _DIRECTION), f'{where}.')
        usual = MAXIMISE if name == ENGAGED else MINIMISE
        sense = keys.get(_DIRECTION, usual)
        require_choice(f'{where}.{_DIRECTION}', sense, (MINIMISE, MAXIMISE))
        if name == UPDATE_TIME:
            raise ParameterError(f'{where} differs each time: make it a constraint', key=where)
        goals.append(Goal(name, _statistic(where, name, keys, 'mean'), sense))
    return tuple(goals)


def constraints_of(content: Any) -> tuple[Constraint, ...]:
    """Return the constraints of a specification; raise ParameterError that names the key."""
    found = []
    for name, described in (_named(CONSTRAINTS, content) if content else {}).items():
        where = f'{CONSTRAINTS}.{name}'
        keys = mapping_of(where, described, (_STATISTIC, AT_MOST, AT_LEAST), f'{where}.')
        ends = [key for key in (AT_MOST, AT_LEAST) if key in keys]
        if len(ends) != 1:
            raise ParameterError(f'{where}: give either {AT_MOST} or {AT_LEAST}', key=where)
        (end,) = ends
        limit = require_number(f'{where}.{end}', keys[end])
        sense: Sense = 'minimise' if end == AT_MOST else 'maximise'
        found.append(Constraint(Goal(name, _statistic(where, name, keys, 'worst'), sense), limit))
    return tuple(found)


def require_engaged(objectives: Sequence[Goal], constraints: Sequence[Constraint]) -> None:
    """Raise ParameterError where a controller that seldom engages could be the best."""
    goals = (*objectives, *(each.goal for each in constraints))
    of_engaged = any(goal.of_runs and goal.name != ENGAGED for goal in objectives)
    if of_engaged and not any(goal.name == ENGAGED for goal in goals):
        raise ParameterError(
            f'{CONSTRAINTS}.{ENGAGED} is missing: objectives are over the runs that engage, so '
            'one that seldom engages could win: give the least share, or make it an objective',
            key=f'{CONSTRAINTS}.{ENGAGED}',
        )


def _named(where: str, content: Any) -> Mapping[str, Any]:
    if not isinstance(content, Mapping) or not content:
        raise ParameterError(
            f'{where} is {content!r}: give quantities, such as engagement_time_s', key=where
        )
    require_known(content, KNOWN, 'quantity', f'{where}.')
    return content


def _statistic(where: str, name: str, keys: Mapping[str, Any], usual: str) -> str:
    key = f'{where}.{_STATISTIC}'
    if name in (ENGAGED, *OF_LOOP, UPDATE_TIME):
        if _STATISTIC in keys:
            raise ParameterError(f'{key}: {name} is one number for a trial: leave it out', key=key)
        return ''
    statistic = keys.get(_STATISTIC, usual)
    require_choice(key, statistic, STATISTICS)
    return str(statistic)
