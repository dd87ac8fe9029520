# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rows of controllers on the same cases, as arrays with a row for each controller."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pyarrow as pa

from ddct_bringup.campaign.arrow_columns import numpy_columns
from ddct_bringup.campaign.columns import CONTROLLER
from ddct_plant.base.errors import DdctError

CASE = 'case'
"""Column of the number of the case, which no row has: it follows from its place."""


@dataclass(frozen=True, eq=False)
class CaseRows:
    """Columns of controllers on the same cases, in the same order."""

    controllers: tuple[str, ...]
    columns: Mapping[str, np.ndarray]
    """Columns by name, (controllers, cases) each; NaN for an undefined number."""

    @classmethod
    def of_table(cls, table: pa.Table) -> 'CaseRows':
        """Return the rows of a campaign; raise DdctError where controllers have other cases."""
        names = table[CONTROLLER].to_pylist()
        controllers = tuple(dict.fromkeys(names))
        cases = len(names) // max(len(controllers), 1)
        if names != [name for name in controllers for _ in range(cases)]:
            raise DdctError('the rows of controllers are not those of the same cases')
        shape = (len(controllers), cases)
        columns = {name: each.reshape(shape) for name, each in numpy_columns(table).items()}
        return cls(controllers, columns)

    @property
    def cases(self) -> int:
        """Number of cases."""
        return int(self.columns[CONTROLLER].shape[1])

    def of(self, controller: str) -> Mapping[str, np.ndarray]:
        """Return the columns of one controller, (cases,) each, and the numbers of the cases."""
        place = self._place(controller)
        columns = {name: column[place] for name, column in self.columns.items()}
        return {**columns, CASE: np.arange(self.cases)}

    def only(self, controllers: Sequence[str]) -> 'CaseRows':
        """Return the rows of some controllers, in the order in which they are given."""
        places = [self._place(each) for each in controllers]
        columns = {name: column[places] for name, column in self.columns.items()}
        return CaseRows(tuple(controllers), columns)

    def of_cases(self, cases: Sequence[int] | np.ndarray) -> 'CaseRows':
        """Return the rows of some cases."""
        chosen = np.asarray(cases, dtype=int)
        columns = {name: column[:, chosen] for name, column in self.columns.items()}
        return CaseRows(self.controllers, columns)

    def beside(self, others: 'CaseRows') -> 'CaseRows':
        """
        Return these rows followed by those of other controllers, with the columns that both have.

        Raise DdctError where the others have another number of cases.
        """
        if others.cases != self.cases:
            raise DdctError(f'{others.cases} cases are not the {self.cases} of the others')
        added = [each for each in others.controllers if each not in self.controllers]
        places = [others.controllers.index(each) for each in added]
        columns = {
            name: np.concatenate([column, others.columns[name][places]])
            for name, column in self.columns.items()
            if name in others.columns
        }
        return CaseRows((*self.controllers, *added), columns)

    def _place(self, controller: str) -> int:
        if controller not in self.controllers:
            raise DdctError(f'there are no rows of {controller}: run make benchmark-rows')
        return self.controllers.index(controller)
