# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""H-infinity synthesis by linear matrix inequalities, the thesis's own route (Section 3.2.2)."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from scipy.linalg import block_diag, null_space
from scipy.sparse import csc_matrix

from ddct_controllers.design.h_infinity.synthesis.gamma_iteration import (
    Synthesis,
    verified_norm,
)
from ddct_controllers.design.h_infinity.synthesis.generalised_plant import (
    GeneralisedPlant,
    balanced,
)
from ddct_controllers.design.h_infinity.synthesis.riccati import central_controller
from ddct_plant.base.errors import DdctError, ParameterError

_DISCOUNTS_RAD_S = (30.0, 10.0, 3.0, 50.0)
"""Decay rates in rad/s of the Gramians that balance the coordinates, tried in turn."""
_EXCESS = 1.01
"""Ratio of the norm to the optimum of the LMIs up to which a controller is accepted."""
_Affine = Callable[[np.ndarray, np.ndarray, float, float], np.ndarray]
"""A symmetric matrix, affine in R, S and gamma; the last argument multiplies its constants."""


def synthesise_by_lmi(plant: GeneralisedPlant) -> Synthesis:
    """
    Return the controller of Gahinet and Apkarian's convex problem, solved by Clarabel.

    gamma is minimised over R, S with the two projected bounded-real inequalities and
    [R I; I S] >= 0; the controller is the central one for X = gamma R^-1, Y = gamma S^-1. In raw
    coordinates the solver finds no optimum, as R and S range over ten decades. Raise
    DdctError when no closed loop verifies, and without the package clarabel.
    """
    try:
        import clarabel
    except ImportError as error:
        raise DdctError(
            'the LMI method needs a solver of semidefinite programs: pip install clarabel, '
            'or use the Riccati method'
        ) from error
    plant.require_solvable()
    for discount in _DISCOUNTS_RAD_S:
        coordinates = balanced(plant, discount)
        solution = _solved(clarabel, coordinates)
        if solution is None:
            continue
        optimum, r, s = solution
        try:
            x, y = optimum * np.linalg.inv(r), optimum * np.linalg.inv(s)
            controller = central_controller(coordinates, optimum, x, y)
        except (np.linalg.LinAlgError, ParameterError):
            continue
        norm = verified_norm(plant, controller)
        if norm <= _EXCESS * optimum:
            return Synthesis(controller, norm, norm, optimum, 'lmi')
    raise DdctError(
        'synthesis by LMI: no solution gave a closed loop that verifies: use the Riccati method, '
        'or scale the weights to about 1 near the crossover',
        key='weights',
    )


def _solved(clarabel: Any, plant: GeneralisedPlant) -> tuple[float, np.ndarray, np.ndarray] | None:
    """Return gamma, R and S, (n, n) each, or None when the solver finds no solution."""
    size = len(plant.system.a)
    basis, none = list(_symmetric_basis(size)), np.zeros((size, size))
    unknowns = [(matrix, none, 0.0) for matrix in basis]
    unknowns += [(none, matrix, 0.0) for matrix in basis] + [(none, none, 1.0)]
    rows, constants, cones = [], [], []
    for inequality in _inequalities(plant):
        constant = _packed(inequality(none, none, 0.0, 1.0))
        rows.append(np.column_stack([-_packed(inequality(*x, 0.0)) for x in unknowns]))
        constants.append(constant)
        cones.append(clarabel.PSDTriangleConeT(round((np.sqrt(8 * len(constant) + 1) - 1) / 2)))
    cost = np.zeros(len(unknowns))
    cost[-1] = 1.0
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    found = clarabel.DefaultSolver(
        csc_matrix((len(cost), len(cost))),
        cost,
        csc_matrix(np.vstack(rows)),
        np.concatenate(constants),
        cones,
        settings,
    ).solve()
    if str(found.status) not in ('Solved', 'AlmostSolved'):
        return None
    values = np.array(found.x)
    r = np.tensordot(values[: len(basis)], basis, axes=1)
    s = np.tensordot(values[len(basis) : -1], basis, axes=1)
    return float(values[-1]), r, s


def _inequalities(plant: GeneralisedPlant) -> Sequence[_Affine]:
    """Return the three matrices that must be positive semidefinite."""
    a, b1, c1, d11 = plant.system.a, plant.b1, plant.c1, plant.d11
    no_w, no_z = np.eye(b1.shape[1]), np.eye(len(c1))
    free_of_u = block_diag(null_space(np.hstack([plant.b2.T, plant.d12.T])), no_w)
    free_of_v = block_diag(null_space(np.hstack([plant.c2, plant.d21])), no_z)

    def control(r: np.ndarray, _: np.ndarray, gamma: float, one: float) -> np.ndarray:
        return -free_of_u.T @ _bounded_real(r, a.T, c1, b1, d11, gamma, one) @ free_of_u

    def estimation(_: np.ndarray, s: np.ndarray, gamma: float, one: float) -> np.ndarray:
        return -free_of_v.T @ _bounded_real(s, a, b1.T, c1.T, d11.T, gamma, one) @ free_of_v

    def coupling(r: np.ndarray, s: np.ndarray, _: float, one: float) -> np.ndarray:
        return np.block([[r, one * np.eye(len(a))], [one * np.eye(len(a)), s]])

    return control, estimation, coupling


def _bounded_real(
    x: np.ndarray,
    a: np.ndarray,
    c: np.ndarray,
    b: np.ndarray,
    d: np.ndarray,
    gamma: float,
    one: float,
) -> np.ndarray:
    """Return [a'x + x a, x c', b; c x, -gamma, d; b', d', -gamma], constants times `one`."""
    return np.block(
        [
            [a.T @ x + x @ a, x @ c.T, one * b],
            [c @ x, -gamma * np.eye(len(c)), one * d],
            [one * b.T, one * d.T, -gamma * np.eye(b.shape[1])],
        ]
    )


def _symmetric_basis(size: int) -> Iterator[np.ndarray]:
    for column in range(size):
        for row in range(column + 1):
            matrix = np.zeros((size, size))
            matrix[row, column] = matrix[column, row] = 1.0
            yield matrix


def _packed(matrix: np.ndarray) -> np.ndarray:
    """Return the upper triangle by columns, off-diagonal entries times sqrt(2)."""
    columns, rows = np.tril_indices(len(matrix))
    return matrix[rows, columns] * np.where(rows == columns, 1.0, np.sqrt(2.0))
