"""A quadratic program in variables and rows of comparable size, as the solvers get it."""

from dataclasses import dataclass

import numpy as np

from ddct_controllers.mpc.qp.problem import QpStructure


@dataclass(frozen=True, eq=False)
class ScaledQp:
    """
    A QpStructure in y = z / variables, each row of G multiplied by its entry of `rows`.

    Solvers compare residuals with absolute tolerances: so these mean the same for every unit of
    the inputs and outputs, and both solvers stop at the same accuracy. The cost is unchanged.
    """

    hessian: np.ndarray
    """(n, n), unit diagonal."""
    constraints: np.ndarray
    """(m, n), rows of unit length; a row of zeros stays one."""
    soft_rows: np.ndarray
    """(number of soft rows,) their indices."""
    soft_weights: np.ndarray
    """(number of soft rows,) w of each, for slacks multiplied like their rows."""
    variables: np.ndarray
    """(n,) above 0."""
    rows: np.ndarray
    """(m,) above 0."""


def scale(structure: QpStructure) -> ScaledQp:
    """Return `structure` scaled by the diagonal of its hessian and the lengths of its rows."""
    variables = 1.0 / np.sqrt(np.diag(structure.hessian))
    constraints = structure.constraints * variables
    lengths = np.linalg.norm(constraints, axis=1)
    rows = 1.0 / np.where(lengths > 0.0, lengths, 1.0)
    soft_rows = structure.soft_rows
    weight = structure.soft_weight or 0.0  # None when no row is soft
    return ScaledQp(
        hessian=structure.hessian * variables * variables[:, None],
        constraints=constraints * rows[:, None],
        soft_rows=soft_rows,
        soft_weights=weight / rows[soft_rows] ** 2,
        variables=variables,
        rows=rows,
    )
