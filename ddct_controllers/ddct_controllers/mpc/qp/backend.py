# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The interface behind which solvers of quadratic programs are swapped, and solvers by name."""

import math
import sys
from abc import ABC, abstractmethod
from collections.abc import Sequence
from importlib import import_module
from typing import Any

import numpy as np

from ddct_controllers.mpc.qp.problem import QpSolution, QpStatus, QpStructure
from ddct_plant.base.errors import DdctError, ParameterError, require_choice
from ddct_plant.base.options import REQUIRED, Option

Vector = np.ndarray | Sequence[float]

BACKENDS = ('daqp', 'osqp')
"""Names of the backends, which are those of the solvers' packages."""
DEFAULT_BACKEND = 'daqp'
"""Name of the backend that is fastest at equal accuracy; `tools/run bench` measures both."""
ITERATION_LIMITS = {'daqp': 1000, 'osqp': 20_000}
"""
Limits by backend, ten and four times what the hardest programs of `tools/run bench` need.

OSQP's iterations are far cheaper.
"""
_ITERATION_LIMIT = Option(REQUIRED, 'iterations of a solver', kind=int, at_least=1)
_LARGEST = sys.float_info.max


class QpBackend(ABC):
    """
    Solve programs of one structure, each solve starting from the solution of the last one.

    After a solve that fails the next one starts anew. Deterministic: the same solves after `reset`
    give the same bits. Raise ParameterError when `iteration_limit` is below 1, DdctError when the
    solver's package is missing.

    The solver gets the program in y = z / variables, each row of G multiplied by its entry of
    `rows`. Solvers compare residuals with absolute tolerances: so these mean the same for every
    unit of the inputs and outputs, and both solvers stop at the same accuracy. The cost is
    unchanged.
    """

    def __init__(self, structure: QpStructure, iteration_limit: int) -> None:
        self._iteration_limit = _ITERATION_LIMIT.checked('QP: iteration_limit', iteration_limit)
        self._structure = structure
        variables = 1.0 / np.sqrt(np.diag(structure.hessian))
        constraints = structure.constraints * variables
        lengths = np.linalg.norm(constraints, axis=1)
        rows = 1.0 / np.where(lengths > 0.0, lengths, 1.0)
        self._variables, self._rows = variables, rows
        """Scale factors of the variables, (n,), and of the rows, (m,), above 0."""
        self._hessian = structure.hessian * variables * variables[:, None]
        """Scaled Hessian, (n, n), with a unit diagonal."""
        self._constraints = constraints * rows[:, None]
        """Scaled constraints, (m, n), rows of unit length; a row of zeros stays one."""
        self._soft_rows = structure.soft_rows
        weight = structure.soft_weight or 0.0  # None when no row is soft
        self._soft_weights = weight / rows[self._soft_rows] ** 2
        """Weight w of each soft row, (soft rows,), for slacks multiplied like their rows."""
        self.reset()

    @abstractmethod
    def reset(self) -> None:
        """Return to the state of a new backend, without a warm start."""

    @abstractmethod
    def _solve_scaled(
        self, f: np.ndarray, lower: np.ndarray, upper: np.ndarray
    ) -> tuple[np.ndarray, int, QpStatus]:
        """Return the scaled variables (used only if solved), iterations and status."""

    def solve(self, f: Vector, lower: Vector, upper: Vector) -> QpSolution:
        """
        Return the solution for f (n,) and the bounds of the rows, (m,) each.

        Bounds may be infinite. Raise ParameterError for wrong shapes, NaN, an infinite f, or
        bounds that no number lies between; a program without a solution is no error.
        """
        f, lower, upper = (np.asarray(vector, dtype=float) for vector in (f, lower, upper))
        self._check(f, lower, upper)
        y, iterations, status = self._solve_scaled(
            self._variables * f, self._rows * lower, self._rows * upper
        )
        if status != 'solved':
            self.reset()
            return QpSolution(np.full(len(f), math.nan), iterations, status)
        return QpSolution(self._variables * y, iterations, status)

    def _check(self, f: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> None:
        rows, size = self._structure.constraints.shape
        if f.shape != (size,) or lower.shape != (rows,) or upper.shape != (rows,):
            raise ParameterError(
                f'QP: f is {f.shape}, lower {lower.shape} and upper {upper.shape}; '
                f'({size},), ({rows},) and ({rows},) are needed',
                key='f',
            )
        # The product, which is infinite above 1e154 too, saves the slower check in the loop.
        if not (math.isfinite(f @ f) or np.isfinite(f).all()):
            raise ParameterError(f'QP: f is not finite: {f}', key='f')
        usable = np.maximum(lower, -_LARGEST) <= np.minimum(upper, _LARGEST)
        if not usable.all():
            row = int(np.argmin(usable))
            raise ParameterError(
                f'QP: row {row} must lie between {lower[row]:g} and {upper[row]:g}: no number '
                'does',
                key=f'row {row}',
            )


def make_backend(
    name: str, structure: QpStructure, iteration_limit: int | None = None
) -> QpBackend:
    """
    Return the backend called `name` for programs of `structure`; its own limit if none is given.

    Only its solver is imported. Raise ParameterError for an unknown name or a
    limit below 1, DdctError when the backend's package is not installed.
    """
    require_choice('QP backend', name, BACKENDS)
    limit = ITERATION_LIMITS[name] if iteration_limit is None else iteration_limit
    # Only here: the solvers are built on this module.
    from ddct_controllers.mpc.qp.solvers import SOLVERS

    return SOLVERS[name](structure, limit)


def solver_package(name: str) -> Any:
    """Return the package of the backend called `name`; raise DdctError if it is not installed."""
    try:
        return import_module(name)
    except ImportError as error:
        (other,) = set(BACKENDS) - {name}
        raise DdctError(
            f'the QP backend {name} needs the package {name}: pip install {name}, or choose '
            f'{other}',
            key=name,
        ) from error
