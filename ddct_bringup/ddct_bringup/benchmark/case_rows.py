# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rows of controllers on the same cases, as one table."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pyarrow as pa

from ddct_bringup.campaign.arrow_columns import arrow_column
from ddct_bringup.campaign.keys import SCENARIO
from ddct_bringup.campaign.rows import CONTROLLER, INDEX
from ddct_bringup.evaluation.grouped_rows import By
from ddct_plant.base.errors import DdctError


@dataclass(frozen=True, eq=False)
class CaseRows:
    """
    Rows of controllers on the same cases, controller by controller, the cases in the same order.

    Raise DdctError where controllers have other cases.
    """

    rows: pa.Table
    """Rows with the columns of a campaign."""

    def __post_init__(self) -> None:
        """Check that each controller has all cases."""
        names = self.rows[CONTROLLER].to_pylist()
        if names != [name for name in self.controllers for _ in range(self.cases)]:
            raise DdctError('the rows of controllers are not those of the same cases')

    @cached_property
    def controllers(self) -> tuple[str, ...]:
        """Names of the controllers."""
        return tuple(dict.fromkeys(self.rows[CONTROLLER].to_pylist()))

    @property
    def cases(self) -> int:
        """Number of cases."""
        return len(self.rows) // max(len(self.controllers), 1)

    @property
    def table(self) -> pa.Table:
        """Rows with the number of the case of each as its index."""
        cases = [*range(self.cases)] * len(self.controllers)
        others = [name for name in self.rows.column_names if name != INDEX]
        return self.rows.select(others).append_column(INDEX, arrow_column(pa.int64(), cases))

    def by(
        self, varied: Sequence[str], focus: tuple[str, ...] = (), *, dominance: bool = False
    ) -> By:
        """
        Return how the rows are summarised: a group for each controller, with parts by scenario.

        `varied` are the keys that were drawn. An invalid run is a failure.
        """
        columns = self.rows.column_names
        return By(
            grid=(SCENARIO,),
            random=tuple(key for key in varied if key in columns),
            parts=SCENARIO,
            invalid_fails=True,
            dominance=dominance,
            focus=focus,
        )

    def only(self, controllers: Sequence[str]) -> 'CaseRows':
        """Return the rows of some controllers, each once, in the order in which they are given."""
        parts = map(self._part, dict.fromkeys(controllers))
        return CaseRows(pa.concat_tables([self.rows.slice(0, 0), *parts]))

    def of_cases(self, cases: Sequence[int] | np.ndarray) -> 'CaseRows':
        """Return the rows of some cases."""
        firsts = self.cases * np.arange(len(self.controllers))
        places = (firsts[:, np.newaxis] + np.asarray(cases, dtype=int)).ravel()
        return CaseRows(self.rows.take(arrow_column(pa.int64(), places.tolist())))

    def beside(self, others: 'CaseRows') -> 'CaseRows':
        """
        Return these rows followed by those of other controllers, with the columns that both have.

        Raise DdctError where the others have another number of cases.
        """
        if others.cases != self.cases:
            raise DdctError(f'{others.cases} cases are not the {self.cases} of the others')
        added = [each for each in others.controllers if each not in self.controllers]
        both = [name for name in self.rows.column_names if name in others.rows.column_names]
        parts = [each.select(both) for each in (self.rows, *map(others._part, added))]
        return CaseRows(pa.concat_tables(parts, promote_options='permissive'))

    def _part(self, controller: str) -> pa.Table:
        return self.rows.slice(self._first(controller), self.cases)

    def _first(self, controller: str) -> int:
        """Return the place of the first row of a controller."""
        if controller not in self.controllers:
            raise DdctError(f'there are no rows of {controller}: run tools/run benchmark_rows')
        return self.controllers.index(controller) * self.cases
