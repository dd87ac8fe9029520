# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Linear programs by the dual simplex method of HiGHS, where our method does not converge."""

import numpy as np
import scipy

from ddct_bringup.floor.program.interior_point import Optimum
from ddct_bringup.floor.program.linear_program import LinearProgram
from ddct_plant.base.errors import DdctError

_NEGLIGIBLE = 1e-7
"""Share of the largest entry of a row below which HiGHS gets a zero instead."""
_OPTIONS = {
    'primal_feasibility_tolerance': 1e-7,
    'dual_feasibility_tolerance': 1e-9,
    'presolve': False,
    'maxiter': 100_000,
}
"""Options of HiGHS. Every inexact multiplier costs a bound its share of the box."""
_SOLVED, _INFEASIBLE = 0, 2
"""Numbers that scipy gives these results."""


def highs(program: LinearProgram) -> Optimum | None:
    """
    Return the optimum of a program, None where it has no point.

    Raise DdctError where HiGHS finds neither a point nor that there is none.
    """
    rows = program.rows
    largest = np.abs(rows).max(axis=1, keepdims=True, initial=0.0)
    sparse = scipy.sparse.csr_array(np.where(np.abs(rows) > _NEGLIGIBLE * largest, rows, 0.0))
    found = scipy.optimize.linprog(
        program.cost,
        sparse,
        program.limits,
        program.equal_rows,
        program.equal_values,
        np.column_stack([program.low, program.high]),
        # The interior-point method of HiGHS may never end, even with two variables.
        'highs-ds',
        options=_OPTIONS,
    )
    if found.status == _INFEASIBLE:
        return None
    if found.status != _SOLVED:
        raise DdctError(f'HiGHS: {found.message}')
    return Optimum(found.x, -found.ineqlin.marginals, -found.eqlin.marginals)
