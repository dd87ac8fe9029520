# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Linear programs by HiGHS: by its dual simplex method, else by its interior-point method.

What it returns proves nothing; the multipliers are checked as those of any solver.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from ddct_bringup.floor.program.linear_program import LinearProgram
from ddct_plant.base.errors import DdctError

_METHODS = {'highs-ds': False, 'highs-ipm': True}
"""
Methods in turn, and whether each one simplifies the program first.

The simplex method takes half of the time, most of it without. It may stop early; the
interior-point method may never end, even with two variables.
"""
_TIME_S = 30.0
"""Time limit of one method in s, a hundred times what a program usually takes."""
_NEGLIGIBLE = 1e-7
"""Share of the largest entry of a row below which HiGHS gets a zero instead."""
_OPTIONS = {
    'primal_feasibility_tolerance': 1e-7,
    'dual_feasibility_tolerance': 1e-9,
    'time_limit': _TIME_S,
}
"""Options of HiGHS. Every inexact multiplier costs a bound its share of the box."""
_SOLVED, _INFEASIBLE = 0, 2
"""Numbers that scipy gives these results."""


@dataclass(frozen=True, eq=False)
class Optimum:
    """Best point of a program, (n,), and the multipliers of its rows and equations."""

    point: np.ndarray
    rows: np.ndarray
    equal: np.ndarray


def highs(program: LinearProgram) -> Optimum | None:
    """
    Return the optimum of a program, None where it has no point.

    Raise DdctError where HiGHS finds neither a point nor that there is none.
    """
    rows = program.rows
    largest = np.abs(rows).max(axis=1, keepdims=True, initial=0.0)
    sparse = scipy.sparse.csr_array(np.where(np.abs(rows) > _NEGLIGIBLE * largest, rows, 0.0))
    for method, presolve in _METHODS.items():
        found = scipy.optimize.linprog(
            program.cost,
            sparse,
            program.limits,
            program.equal_rows,
            program.equal_values,
            np.column_stack([program.low, program.high]),
            method,
            options={**_OPTIONS, 'presolve': presolve},
        )
        if found.status == _INFEASIBLE:
            return None
        if found.status == _SOLVED:
            return Optimum(found.x, -found.ineqlin.marginals, -found.eqlin.marginals)
    raise DdctError(f'HiGHS: {found.message}')
