"""A quadratic program in the coordinates in which the exported solver works."""

from dataclasses import dataclass

import numpy as np

from ddct_controllers.mpc.qp.problem import QpStructure


@dataclass(frozen=True, eq=False)
class DualForm:
    """
    A QpStructure in y = L' z with H = L L', where the cost is 1/2 y'y + v'y and v = L^-1 f.

    Rows are divided by their length in y. A soft row that no variable moves is left out: its
    slack costs the same whatever is decided. r rows are left.
    """

    to_dual: np.ndarray
    """(n, n), L^-1."""
    moves: np.ndarray
    """(n, n), z = moves @ y."""
    normals: np.ndarray
    """(r, n), of unit length, or 0 for a hard row of zeros."""
    relaxation: np.ndarray
    """(r,) the inverse weight of a soft row's slack in the row's new unit; 0 for a hard row."""
    kept: np.ndarray
    """(r,) which rows of the structure these are."""
    scale: np.ndarray
    """(r,) what each was multiplied by, as its bounds must be."""

    @property
    def capacity(self) -> int:
        """
        Return how many rows can be active at once: the hard ones independent, the soft ones all.

        At least 2, as compilers warn of loops over arrays of 1.
        """
        rows, size = self.normals.shape
        soft = int(np.count_nonzero(self.relaxation))
        return max(min(rows, size + soft), 2)


def dual_form(structure: QpStructure) -> DualForm:
    """Return the structure in the solver's coordinates."""
    # Imported here: only exports need it.
    from scipy.linalg import solve_triangular

    factor = np.linalg.cholesky(structure.hessian)
    to_dual = solve_triangular(factor, np.eye(len(factor)), lower=True)
    normals = structure.constraints @ to_dual.T
    lengths = np.linalg.norm(normals, axis=1)
    soft = np.asarray(structure.soft)
    kept = np.flatnonzero(~soft | (lengths > 0.0))
    scale = 1.0 / np.where(lengths > 0.0, lengths, 1.0)[kept]
    weight = structure.soft_weight or 1.0  # None when no row is soft
    relaxation = np.where(soft[kept], scale**2 / weight, 0.0)
    return DualForm(to_dual, to_dual.T, normals[kept] * scale[:, None], relaxation, kept, scale)
