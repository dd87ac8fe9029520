# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The two Riccati equations of H-infinity synthesis and the central controller they give."""

import numpy as np
import scipy

from ddct_controllers.design.h_infinity.synthesis.generalised_plant import GeneralisedPlant
from ddct_plant.linear.lti import StateSpace


def stabilising_solutions(plant: GeneralisedPlant, gamma: float) -> tuple[np.ndarray, np.ndarray]:
    """
    Return X and Y of Glover and Doyle, (n, n) each, for the level `gamma`.

    Raise numpy.linalg.LinAlgError where a Hamiltonian matrix has no stable subspace of dimension
    n: then no controller reaches the level.
    """
    a, b, c = plant.system.a, plant.system.b, plant.system.c
    row = np.hstack([plant.d11, plant.d12])
    column = np.vstack([plant.d11, plant.d21])
    x = _riccati(a, b, plant.c1.T @ plant.c1, _level(row, gamma), plant.c1.T @ row)
    y = _riccati(a.T, c.T, plant.b1 @ plant.b1.T, _level(column.T, gamma), plant.b1 @ column.T)
    return x, y


def central_controller(
    plant: GeneralisedPlant, gamma: float, x: np.ndarray, y: np.ndarray
) -> StateSpace:
    """
    Return the controller of Glover and Doyle (1988) for the level `gamma` and its X and Y.

    Control and measurement are scaled, and w and z rotated, so that D12 = [0; 1], D21 = [0 1].
    Raise numpy.linalg.LinAlgError where the level is below what D11 alone needs.
    """
    rotate_z, control = _compressed(plant.d12)
    rotate_w, measurement = _compressed(plant.d21.T)
    a, n, g2 = plant.system.a, len(plant.system.a), gamma**2
    b1, b2 = plant.b1 @ rotate_w, plant.b2 / control
    c1, c2 = rotate_z.T @ plant.c1, plant.c2 / measurement
    d11 = rotate_z.T @ plant.d11 @ rotate_w
    z_unit, w_unit = np.eye(len(d11))[:, -1:], np.eye(d11.shape[1])[-1:]
    row, column = np.hstack([d11, z_unit]), np.vstack([d11, w_unit])
    b, c = np.hstack([b1, b2]), np.vstack([c1, c2])
    f = -np.linalg.solve(_level(row, gamma), row.T @ c1 + b.T @ x)
    h = -np.linalg.solve(_level(column.T, gamma), (b1 @ column.T + y @ c.T).T).T
    d1111, d1112 = d11[:-1, :-1], d11[:-1, -1:]
    d1121, d1122 = d11[-1:, :-1], d11[-1:, -1:]
    left = np.linalg.inv(g2 * np.eye(len(d1111)) - d1111 @ d1111.T)
    right = np.linalg.inv(g2 * np.eye(d1111.shape[1]) - d1111.T @ d1111)
    through = -d1121 @ d1111.T @ left @ d1112 - d1122
    d_12 = np.linalg.cholesky(np.eye(1) - d1121 @ right @ d1121.T)
    d_21 = np.linalg.cholesky(np.eye(1) - d1112.T @ left @ d1112).T
    coupling = np.linalg.inv(np.eye(n) - y @ x / g2)
    b_2 = coupling @ (b2 + h[:, -2:-1]) @ d_12
    c_2 = -d_21 @ (c2 + f[-2:-1])
    b_1 = -coupling @ h[:, -1:] + b_2 @ np.linalg.solve(d_12, through)
    c_1 = f[-1:] + through @ np.linalg.solve(d_21, c_2)
    a_k = a + b @ f + b_1 @ np.linalg.solve(d_21, c_2)
    found = StateSpace(a_k, b_1 / measurement, c_1 / control, through / (control * measurement))
    return _around_feedthrough(found, plant.d22)


def _riccati(
    a: np.ndarray, b: np.ndarray, q: np.ndarray, r: np.ndarray, s: np.ndarray
) -> np.ndarray:
    """
    Return the stabilising X of a'X + X a + q - (X b + s) r^-1 (b'X + s') = 0, r indefinite.

    From the stable subspace of the balanced Hamiltonian matrix. scipy's solver refuses the
    problems of this thesis, whose slowest modes are 1e-6 of the fastest.
    """
    n = len(a)
    r_inverse = np.linalg.inv(r)
    drift = a - b @ r_inverse @ s.T
    hamiltonian = np.block([[drift, -b @ r_inverse @ b.T], [s @ r_inverse @ s.T - q, -drift.T]])
    balanced, scale = scipy.linalg.matrix_balance(hamiltonian)
    _, vectors, stable = scipy.linalg.schur(balanced, output='real', sort='lhp')
    if stable != n:
        raise np.linalg.LinAlgError('the Hamiltonian matrix has eigenvalues on the axis')
    subspace = scale @ vectors[:, :n]
    x = np.linalg.solve(subspace[:n].T, subspace[n:].T)
    return (x + x.T) / 2.0


def _level(row: np.ndarray, gamma: float) -> np.ndarray:
    """Return row' row with gamma^2 taken off for all inputs but the last, the control."""
    level = row.T @ row
    size = len(level) - 1
    level[:size, :size] -= gamma**2 * np.eye(size)
    return level


def _compressed(column: np.ndarray) -> tuple[np.ndarray, float]:
    """Return a rotation Q and a size s with Q' column = [0, ..., 0, s]."""
    left, sizes, right = np.linalg.svd(column)
    rotation = np.hstack([left[:, 1:], left[:, :1] * right[0, 0]])
    return rotation, float(sizes[0])


def _around_feedthrough(controller: StateSpace, d22: np.ndarray) -> StateSpace:
    """Return the controller for a plant with D22 from that for the same plant without it."""
    inverse = np.linalg.inv(np.eye(1) + controller.d @ d22)
    c, d = inverse @ controller.c, inverse @ controller.d
    return StateSpace(
        controller.a - controller.b @ d22 @ c, controller.b @ (np.eye(1) - d22 @ d), c, d
    )
