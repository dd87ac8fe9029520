"""OSQP, an operator-splitting (ADMM) solver of sparse programs, as a QP backend."""

import numpy as np
from scipy import sparse

from ddct_controllers.mpc.qp.backend import QpBackend, solver_package
from ddct_controllers.mpc.qp.problem import QpStatus

_SETTINGS = {
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
_STATUS: dict[int, QpStatus] = {1: 'solved', 3: 'infeasible'}
"""All other values say that it stopped without an answer."""


class Backend(QpBackend):
    """
    Primal and dual iterates and the step size are warm-started; soft rows get slack variables.

    Stellato et al., "OSQP: an operator splitting solver for quadratic programs", Mathematical
    Programming Computation 12, 2020.
    """

    def reset(self) -> None:
        """Return to the state of a new backend, without a warm start."""
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
            **_SETTINGS,
        )

    def _solve_scaled(
        self, f: np.ndarray, lower: np.ndarray, upper: np.ndarray
    ) -> tuple[np.ndarray, int, QpStatus]:
        size = len(f)
        self._f[:size] = f
        self._solver.update(q=self._f, l=lower, u=upper)
        result = self._solver.solve(raise_error=False)
        status = _STATUS.get(result.info.status_val, 'iteration limit')
        return result.x[:size], result.info.iter, status
