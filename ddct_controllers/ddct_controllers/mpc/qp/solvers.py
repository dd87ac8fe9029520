# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The solvers of quadratic programs behind `QpBackend`.

DAQP is a dual active-set solver of dense programs, OSQP an operator-splitting (ADMM) solver of
sparse ones.
"""

import numpy as np

from ddct_controllers.mpc.qp.backend import QpBackend, solver_package
from ddct_controllers.mpc.qp.problem import QpStatus
from ddct_plant.base.errors import DdctError

_SOFT = 8
"""DAQP's flag of a soft row."""
_UNBOUNDED = 1e30
_DAQP_SETTINGS = {
    'primal_tol': 1e-9,
    'eps_prox': 0.0,  # the structure is positive definite: no regularisation
    'eq_reduction': -1,  # one way through the solver, whatever rows are equalities
}
_DAQP_STATUS: dict[int, QpStatus] = {
    2: 'solved',  # with a soft row outside its bounds
    1: 'solved',
    -1: 'infeasible',
    -6: 'infeasible',  # equality rows that contradict each other
}
"""Status by DAQP's exit flag; all other flags are ends without a solution."""
_OSQP_SETTINGS = {
    'eps_abs': 1e-6,
    'eps_rel': 1e-6,
    'eps_prim_inf': 1e-6,
    'eps_dual_inf': 1e-6,
    'check_termination': 5,
    'adaptive_rho': 1,  # by iterations; it can also go by wall time
    'adaptive_rho_interval': 50,
    'polishing': False,
    'verbose': False,
}
_OSQP_STATUS: dict[int, QpStatus] = {1: 'solved', 3: 'infeasible'}
"""Status by OSQP's exit value; all other values are ends without a solution."""


class Daqp(QpBackend):
    """
    Solver DAQP with warm-started active sets; the Hessian is factorised once.

    Arnström, Bemporad, Axehill, "A Dual Active-Set Solver for Embedded Quadratic Programming Using
    Recursive LDL' Updates", IEEE TAC 67(8), 2022.
    """

    def reset(self) -> None:
        """Return to the state of a new backend, without a warm start."""
        rows, size = self._constraints.shape
        self._sense = np.zeros(rows, dtype=np.intc)
        self._sense[self._soft_rows] = _SOFT
        self._bounded = b''
        unbounded = np.full(rows, _UNBOUNDED)
        self._model = solver_package('daqp').Model()
        # DAQP counts from 1 and stops before its limit.
        self._model.settings = _DAQP_SETTINGS | {'iter_limit': self._iteration_limit + 1}
        flag, _ = self._model.setup(
            self._hessian, np.zeros(size), self._constraints, unbounded, -unbounded, self._sense
        )
        if flag < 0:
            raise DdctError(f'QP: daqp refuses the program (flag {flag}): use another backend')
        if len(self._soft_rows):
            reciprocal = np.zeros(rows)
            reciprocal[self._soft_rows] = 1.0 / self._soft_weights
            self._model.soft_weights(rho_l=reciprocal, rho_u=reciprocal)

    def _solve_scaled(
        self, f: np.ndarray, lower: np.ndarray, upper: np.ndarray
    ) -> tuple[np.ndarray, int, QpStatus]:
        changes = {'f': f, 'bupper': upper, 'blower': lower} if len(upper) else {'f': f}
        bounded = np.isfinite([lower, upper]).tobytes()
        if bounded != self._bounded:
            # A row that is active at a bound that is now infinite would spoil the start: passing a
            # sense empties the active set.
            changes['sense'], self._bounded = self._sense, bounded
        flag = self._model.update(**changes)
        if flag < 0:
            return f, 0, _DAQP_STATUS.get(flag, 'iteration limit')
        y, _, flag, info = self._model.solve()
        iterations = min(info['iterations'], self._iteration_limit)
        return y, iterations, _DAQP_STATUS.get(flag, 'iteration limit')


class Osqp(QpBackend):
    """
    Solver OSQP with warm-started iterates and step size; soft rows get slack variables.

    Stellato et al., "OSQP: an operator splitting solver for quadratic programs", Mathematical
    Programming Computation 12, 2020.
    """

    def reset(self) -> None:
        """Return to the state of a new backend, without a warm start."""
        # Imported here: DAQP does without.
        from scipy import sparse

        rows, size = self._constraints.shape
        slacks = len(self._soft_rows)
        # A slack t = s sqrt(w) costs 1/2 t^2.
        columns = np.zeros((rows, slacks))
        columns[self._soft_rows, np.arange(slacks)] = 1.0 / np.sqrt(self._soft_weights)
        self._f = np.zeros(size + slacks)
        self._solver = solver_package('osqp').OSQP(algebra='builtin')
        self._solver.setup(
            sparse.triu(sparse.block_diag([self._hessian, np.eye(slacks)]), format='csc'),
            self._f,
            sparse.csc_matrix(np.hstack([self._constraints, columns])),
            np.full(rows, -np.inf),
            np.full(rows, np.inf),
            max_iter=self._iteration_limit,
            **_OSQP_SETTINGS,
        )

    def _solve_scaled(
        self, f: np.ndarray, lower: np.ndarray, upper: np.ndarray
    ) -> tuple[np.ndarray, int, QpStatus]:
        size = len(f)
        self._f[:size] = f
        self._solver.update(q=self._f, l=lower, u=upper)
        result = self._solver.solve(raise_error=False)
        status = _OSQP_STATUS.get(result.info.status_val, 'iteration limit')
        return result.x[:size], result.info.iter, status


SOLVERS: dict[str, type[QpBackend]] = {'daqp': Daqp, 'osqp': Osqp}
"""Classes of the solvers by the names of the backends."""
