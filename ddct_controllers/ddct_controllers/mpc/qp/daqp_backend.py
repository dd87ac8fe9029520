"""DAQP, a dual active-set solver of dense programs, as a QP backend."""

import numpy as np

from ddct_controllers.mpc.qp.backend import QpBackend, solver_package
from ddct_controllers.mpc.qp.problem import QpStatus
from ddct_plant.base.errors import DdctError

_SOFT = 8
"""DAQP's mark of a soft row."""
_UNBOUNDED = 1e30
_SETTINGS = {
    'primal_tol': 1e-9,
    'eps_prox': 0.0,  # the structure is positive definite: no regularisation
    'eq_reduction': -1,  # one way through the solver, whatever rows are equalities
}
_STATUS: dict[int, QpStatus] = {
    2: 'solved',  # with a soft row outside its bounds
    1: 'solved',
    -1: 'infeasible',
    -6: 'infeasible',  # equality rows that contradict each other
}
"""All other flags say that it stopped without an answer."""


class Backend(QpBackend):
    """
    Active sets are warm-started; the factorisation of the hessian is made once.

    Arnström, Bemporad, Axehill, "A Dual Active-Set Solver for Embedded Quadratic Programming
    Using Recursive LDL' Updates", IEEE TAC 67(8), 2022.
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
        self._model.settings = _SETTINGS | {'iter_limit': self._iteration_limit + 1}
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
            # A row held at a bound that is now infinite would spoil the start: a given sense
            # empties the active set.
            changes['sense'], self._bounded = self._sense, bounded
        flag = self._model.update(**changes)
        if flag < 0:
            return f, 0, _STATUS.get(flag, 'iteration limit')
        y, _, flag, info = self._model.solve()
        iterations = min(info['iterations'], self._iteration_limit)
        return y, iterations, _STATUS.get(flag, 'iteration limit')
