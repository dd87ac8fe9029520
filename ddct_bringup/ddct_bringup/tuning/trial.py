# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A trial: its values, how far it ran, and what its goals and constraints came to."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal, get_args

import pyarrow as pa

from ddct_bringup.tuning.specification.goals import MINIMISE, Goal, RunColumns
from ddct_bringup.tuning.specification.parameters import Values
from ddct_bringup.tuning.specification.spec import TuningSpec

State = Literal['feasible', 'infeasible', 'dominated']
STATES: tuple[State, ...] = get_args(State)
FEASIBLE, INFEASIBLE, DOMINATED = STATES
"""
States of a trial: it keeps all constraints; it breaks one, or has no value of an objective; it
was ended because another one is better in every objective, whatever its other runs come to.
"""

NO_ROWS = pa.table({})
"""Rows of a trial without runs."""


@dataclass(frozen=True, eq=False)
class Trial:
    """A trial: its values, its runs so far, and what they come to."""

    number: int
    values: Values
    rows: pa.Table = field(default_factory=lambda: NO_ROWS)
    """Rows of its runs so far, with the columns of a campaign."""
    further: Mapping[str, float | None] = field(default_factory=dict)
    """Quantities of its loop and its update time."""
    state: State = FEASIBLE
    reason: str = ''
    """What ended it or makes it infeasible; empty for a feasible one."""

    def with_rows(self, rows: pa.Table) -> 'Trial':
        """Return the trial with further runs."""
        return replace(self, rows=pa.concat_tables([self.rows, rows]) if len(self.rows) else rows)

    def ended(self, state: State, reason: str) -> 'Trial':
        """Return the trial in another state."""
        return replace(self, state=state, reason=reason)

    def checked(self, spec: TuningSpec, cases: int) -> 'Trial':
        """
        Return the trial, infeasible where a constraint is broken whatever its other runs come to.

        `cases` is the number of all its runs. A quantity that was not measured yet breaks nothing.
        """
        if self.state != FEASIBLE:
            return self
        columns = self._columns(spec, cases)
        for constraint in spec.constraints:
            known = constraint.goal.of_runs or constraint.goal.name in self.further
            if known and constraint.breaks(self._value(constraint.goal, columns)):
                return self.ended(INFEASIBLE, constraint.title)
        for goal in spec.objectives:
            if self._value(goal, columns) is None:
                return self.ended(INFEASIBLE, f'no value of {goal.title}')
        return self

    def costs(self, spec: TuningSpec, cases: int) -> tuple[float, ...]:
        """
        Return the objectives of a feasible trial as costs, of which less is better.

        Where runs are left they are the least that is still possible.
        """
        columns = self._columns(spec, cases)
        found = []
        for goal in spec.objectives:
            value = self._value(goal, columns)
            assert value is not None, 'a feasible trial has its objectives'
            found.append(value if goal.sense == MINIMISE else -value)
        return tuple(found)

    def _columns(self, spec: TuningSpec, cases: int) -> RunColumns:
        return RunColumns.of(self.rows, spec.goals, cases - len(self.rows))

    def _value(self, goal: Goal, columns: RunColumns) -> float | None:
        return goal.value(columns) if goal.of_runs else self.further.get(goal.name)

    def estimate(self, goal: Goal, spec: TuningSpec) -> float | None:
        """Return a quantity over the runs that were computed, None for an undefined one."""
        if not goal.of_runs:
            return self.further.get(goal.name)
        return goal.value(self._columns(spec, len(self.rows))) if self.rows else None
