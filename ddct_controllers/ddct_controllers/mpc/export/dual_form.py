# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A condensed program as the exported C has it: its solver's coordinates, its one known vector."""

from dataclasses import dataclass

import numpy as np

from ddct_controllers.mpc.model.transmission_model import SLIP_ACCELERATION, SLIP_SPEED
from ddct_controllers.mpc.program.horizon import CondensedProgram
from ddct_controllers.mpc.program.settings import MpcSettings
from ddct_controllers.mpc.qp.problem import QpStructure
from ddct_plant.base.timebase import PERIOD_S


@dataclass(frozen=True, eq=False)
class DualForm:
    """
    A QpStructure in y = L' z with H = L L', where the cost is 1/2 y'y + v'y and v = L^-1 f.

    Rows are divided by their length in y. A soft row that no variable moves is left out: its
    slack costs the same whatever is decided. r rows are left.
    """

    to_dual: np.ndarray
    """Map L^-1 from f to the solver's coordinates, (n, n)."""
    moves: np.ndarray
    """Map from y to the moves, (n, n): z = moves @ y."""
    normals: np.ndarray
    """Rows in y, (r, n), of unit length, or 0 for a hard row of zeros."""
    relaxation: np.ndarray
    """Inverse weight of each soft row's slack in the row's new unit, (r,); 0 for a hard row."""
    kept: np.ndarray
    """Indices of these rows in the structure, (r,)."""
    scale: np.ndarray
    """Factor by which each row was multiplied, (r,); its bounds take the same factor."""

    @property
    def capacity(self) -> int:
        """
        Return the largest number of active rows: the hard ones independent, the soft ones all.

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


@dataclass(frozen=True, eq=False)
class KnownColumns:
    """
    Columns of a program for one vector of known values, which the exported C fills each period.

    The vector has the observer's state, the inputs before the first move, C_m as measured, C_load,
    the open loop and its jump, then the engine's deviation if C_m is commanded, and the references
    of w_d and of dw_d/dt: f = gradient @ vector, and the bounds are reduced by shift @ its part
    before the references.
    """

    gradient: np.ndarray
    """Map from the vector to f, a row for each variable."""
    shift: np.ndarray
    """Map from the vector without its references, a row for each row of the program."""
    slip_references: int
    """Number of references of w_d in the vector."""
    rate_references: int
    """Number of references of dw_d/dt in the vector."""


def known_columns(program: CondensedProgram, states: int, settings: MpcSettings) -> KnownColumns:
    """Return the columns of a controller's program for an observer with `states` states."""
    slip, rate = _references(program.gradient, settings)
    inputs = len(settings.inputs)
    return KnownColumns(
        np.hstack([_known(program.gradient, states, inputs), slip, rate]),
        _known(program.shift, states, inputs, jump=True),
        slip.shape[1],
        rate.shape[1],
    )


def _known(matrix: np.ndarray, states: int, inputs: int, *, jump: bool = False) -> np.ndarray:
    """
    Return the columns without references of `matrix`, which has them as `CondensedProgram` does.

    With C_m commanded the program's last two states are the demand and the deviation, and C_m is
    not among the known inputs. The open loop is the clutch's target, which enters the cost only;
    the engine's is zero. Only the clutch torque has a jump, and only the bounds depend on it.
    """
    own, rest = np.split(matrix, [states], axis=1)
    deviation = np.zeros((len(matrix), 0))
    if inputs == 1:
        before, engine, load, after = np.split(rest, [1, 2, 3], axis=1)
    else:
        engine, deviation, before, load, after = np.split(rest, [1, 2, 4, 5], axis=1)
    target, change = after[:, :1], np.zeros((len(matrix), 1))
    if jump:
        target, change = change, target
    return np.hstack([own, before, engine, load, target, change, deviation])


def _references(gradient: np.ndarray, settings: MpcSettings) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the columns for the references of w_d and of dw_d/dt; none for one without effect.

    With preview a column is a period's. Otherwise the present values are held, or that of w_d is
    continued along its tangent.
    """
    periods, outputs = settings.prediction_steps, [terms.output for terms in settings.outputs]
    columns = gradient[:, -periods * len(outputs) :].reshape(-1, periods, len(outputs))
    slip = columns[:, :, np.equal(outputs, SLIP_SPEED)].sum(axis=2)
    rate = columns[:, :, np.equal(outputs, SLIP_ACCELERATION)].sum(axis=2)
    if not settings.preview:
        ahead = PERIOD_S * np.arange(1, periods + 1)
        along = slip @ ahead if settings.along_tangent else 0.0
        slip, rate = slip.sum(1, keepdims=True), (rate.sum(1) + along)[:, None]
    return _if_any(slip), _if_any(rate)


def _if_any(columns: np.ndarray) -> np.ndarray:
    return columns if columns.any() else columns[:, :0]
