"""What a solve of a quadratic program gives."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

QpStatus = Literal['solved', 'iteration limit', 'infeasible']


@dataclass(frozen=True, eq=False, slots=True)
class QpSolution:
    """The minimiser, or why there is none; `z` and `violation` are NaN unless solved."""

    z: np.ndarray
    """(n,)."""
    iterations: int
    """In the solver's own unit: changes of its active set (DAQP), or ADMM steps (OSQP)."""
    status: QpStatus
    """
    'iteration limit' when the solver stopped short of its tolerance, 'infeasible' when the hard
    rows contradict each other.
    """
    violation: float
    """By how much the worst soft row lies outside its bounds, in that row's unit; 0 if none."""
