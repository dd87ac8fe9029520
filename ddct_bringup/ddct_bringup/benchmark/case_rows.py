# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rows of controllers on the same cases, as one table."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pyarrow as pa

from ddct_bringup.campaign.arrow_columns import arrow_column, numpy_columns
from ddct_bringup.campaign.columns import CONTROLLER
from ddct_plant.base.errors import DdctError

CASE = 'case'
"""Column of the number of the case, which no row has: it follows from its place."""


@dataclass(frozen=True, eq=False)
class CaseRows:
    """
    Rows of controllers on the same cases, controller by controller, the cases in the same order.

    Raise DdctError where controllers have other cases.
    """

    table: pa.Table
    """Rows with the columns of a campaign; without rows it may have none."""

    def __post_init__(self) -> None:
        """Check that each controller has all cases."""
        if self._names != [name for name in self.controllers for _ in range(self.cases)]:
            raise DdctError('the rows of controllers are not those of the same cases')

    @cached_property
    def _names(self) -> list[str]:
        rows = self.table
        return rows[CONTROLLER].to_pylist() if len(rows) else []

    @cached_property
    def controllers(self) -> tuple[str, ...]:
        """Names of the controllers."""
        return tuple(dict.fromkeys(self._names))

    @property
    def cases(self) -> int:
        """Number of cases."""
        return len(self.table) // max(len(self.controllers), 1)

    @cached_property
    def _columns(self) -> Mapping[str, np.ndarray]:
        """Columns by name, (controllers x cases,) each; NaN for an undefined number."""
        return numpy_columns(self.table)

    def of(self, controller: str) -> Mapping[str, np.ndarray]:
        """
        Return the columns of one controller, (cases,) each, and the numbers of the cases.

        An undefined number is NaN.
        """
        first = self._first(controller)
        columns = {name: each[first : first + self.cases] for name, each in self._columns.items()}
        return {**columns, CASE: np.arange(self.cases)}

    def only(self, controllers: Sequence[str]) -> 'CaseRows':
        """Return the rows of some controllers, each once, in the order in which they are given."""
        parts = map(self._part, dict.fromkeys(controllers))
        return CaseRows(pa.concat_tables([self.table.slice(0, 0), *parts]))

    def of_cases(self, cases: Sequence[int] | np.ndarray) -> 'CaseRows':
        """Return the rows of some cases."""
        firsts = self.cases * np.arange(len(self.controllers))
        places = (firsts[:, np.newaxis] + np.asarray(cases, dtype=int)).ravel()
        return CaseRows(self.table.take(arrow_column(pa.int64(), places.tolist())))

    def beside(self, others: 'CaseRows') -> 'CaseRows':
        """
        Return these rows followed by those of other controllers, with the columns that both have.

        Raise DdctError where the others have another number of cases.
        """
        if others.cases != self.cases:
            raise DdctError(f'{others.cases} cases are not the {self.cases} of the others')
        added = [each for each in others.controllers if each not in self.controllers]
        both = [name for name in self.table.column_names if name in others.table.column_names]
        parts = [each.select(both) for each in (self.table, *map(others._part, added))]
        return CaseRows(pa.concat_tables(parts, promote_options='permissive'))

    def _part(self, controller: str) -> pa.Table:
        return self.table.slice(self._first(controller), self.cases)

    def _first(self, controller: str) -> int:
        """Return the place of the first row of a controller."""
        if controller not in self.controllers:
            raise DdctError(f'there are no rows of {controller}: run make benchmark-rows')
        return self.controllers.index(controller) * self.cases
