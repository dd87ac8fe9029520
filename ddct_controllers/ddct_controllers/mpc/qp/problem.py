# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A quadratic program: the structure, which is constant over the steps, and the solution."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ddct_plant.base.errors import ParameterError, require_number
from ddct_plant.linear.lti import own_matrices

QpStatus = Literal['solved', 'iteration limit', 'infeasible']

WORST_CONDITION = 1e10
"""
Largest condition of the Hessian with a unit diagonal; above it a solution has under six digits.
"""
_ASYMMETRY = 1e-9
"""Largest asymmetry of the Hessian, relative; condensing rounds far below this."""


@dataclass(frozen=True, eq=False)
class QpStructure:
    """
    Minimise 1/2 z' H z + f' z + 1/2 w sum of s_i^2 over z and the slacks s_i of the soft rows.

    A hard row i keeps lower_i <= (G z)_i <= upper_i, a soft one
    lower_i <= (G z)_i + s_i <= upper_i, and each soft row has a slack of its own. n variables,
    m rows; f, lower and upper come with each solve. Arrays are copied and cannot be written.

    Why this penalty: the program is strictly convex in z and s, so its solution is unique,
    continuous in the data and exists whenever the hard rows alone have one; and a row that must
    give way frees no other row, as one slack shared by all would. The price is that an active
    soft row is exceeded by its multiplier over w, even where no conflict forces it: choose w
    large against H. A row counts more when it and its bounds are multiplied by a factor above 1.

    Raise ParameterError for wrong shapes, numbers that are not finite, a weight that is missing
    or not positive, or a Hessian that is not symmetric or too close to singular.
    """

    hessian: np.ndarray
    """Hessian H, (n, n), symmetric and positive definite."""
    constraints: np.ndarray
    """Constraint rows G, (m, n); m may be 0."""
    soft: np.ndarray | None = None
    """Mask of the soft rows, (m,) bool; None makes every row hard."""
    soft_weight: float | None = None
    """Weight w of the squared slacks, above 0; needed when a row is soft."""

    def __post_init__(self) -> None:
        own_matrices(self, 'QP', hessian='nn', constraints='mn')
        if not self.hessian.size:
            raise ParameterError('QP: the hessian is empty: give it a variable', key='hessian')
        _require_definite(self.hessian)
        rows = len(self.constraints)
        soft = np.array(np.zeros(rows, dtype=bool) if self.soft is None else self.soft)
        if soft.shape != (rows,) or soft.dtype != bool:
            raise ParameterError(
                f'QP: soft is {soft.dtype} {soft.shape}, it must be {rows} booleans',
                key='soft',
            )
        if soft.any():
            require_number('QP: soft_weight', self.soft_weight, above=0.0)
        soft.setflags(write=False)
        object.__setattr__(self, 'soft', soft)

    def without_rows(self, gradient: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """
        Return z_0 (1, k) and G z (m, k) of the optimum without rows, for f = gradient (n, k) @ v.

        They map v to its first variable and to the values of the rows. Where the bounds contain
        these, it is the solution, of soft rows too.
        """
        z = -np.linalg.solve(self.hessian, gradient)
        return z[:1], self.constraints @ z

    @property
    def soft_rows(self) -> np.ndarray:
        """Indices of the soft rows, (soft rows,)."""
        return np.flatnonzero(np.asarray(self.soft))


@dataclass(frozen=True, eq=False, slots=True)
class QpSolution:
    """The minimiser, or the reason why there is none; `z` is NaN unless solved."""

    z: np.ndarray
    """Minimiser, (n,)."""
    iterations: int
    """Number of changes of the active set (DAQP), or of ADMM steps (OSQP)."""
    status: QpStatus
    """
    Reason for the end: 'solved', or one of the following.

    'iteration limit' when the solver stopped short of its tolerance, 'infeasible' when the hard
    rows contradict each other.
    """


def _require_definite(hessian: np.ndarray) -> None:
    """Raise ParameterError unless `hessian` is symmetric and safely positive definite."""
    if np.abs(hessian - hessian.T).max() > _ASYMMETRY * np.abs(hessian).max():
        raise ParameterError(
            'QP: the hessian is not symmetric: mend what builds it', key='hessian'
        )
    diagonal = np.diag(hessian)
    if np.any(diagonal <= 0.0):
        variable = int(np.argmin(diagonal))
        raise ParameterError(
            f'QP: variable {variable} costs nothing (its diagonal of the hessian is '
            f'{diagonal[variable]:g}): give it a weight above 0',
            key=f'variable {variable}',
        )
    scale = 1.0 / np.sqrt(diagonal)
    eigenvalues = np.linalg.eigvalsh(hessian * scale * scale[:, None])
    if eigenvalues[0] * WORST_CONDITION < eigenvalues[-1]:
        raise ParameterError(
            'QP: the hessian is singular to working precision (its eigenvalues, scaled to a unit '
            f'diagonal, are {eigenvalues[0]:.1e} to {eigenvalues[-1]:.1e}; at most a ratio of '
            f'{WORST_CONDITION:g} is solved): raise the weights on the inputs or their moves',
            key='hessian',
        )
