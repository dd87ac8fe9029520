# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The generalised plant M of Section 3.1, and coordinates in which it is well conditioned."""

from dataclasses import dataclass

import numpy as np
import scipy

from ddct_plant.base.errors import DdctError
from ddct_plant.linear.lti import StateSpace

_RANK = 1e-10
"""Singular value, relative to the largest, below which one counts as zero."""
DISCOUNT_RAD_S = 30.0
"""Decay rate of the Gramians in rad/s, about the bandwidth of W_t."""


@dataclass(frozen=True, eq=False)
class GeneralisedPlant:
    """
    dx/dt = a x + b1 w + b2 u, z = c1 x + d11 w + d12 u, v = c2 x + d21 w + d22 u.

    w are the external inputs, z the external outputs, u the one control (the last input) and v
    the one controller input (the last output).
    """

    system: StateSpace
    """State-space system from (w, u) to (z, v), continuous."""

    @property
    def b1(self) -> np.ndarray:
        """Matrix from w to the states' rates, (n, inputs w)."""
        return self.system.b[:, :-1]

    @property
    def b2(self) -> np.ndarray:
        """Matrix from u to the states' rates, (n, 1)."""
        return self.system.b[:, -1:]

    @property
    def c1(self) -> np.ndarray:
        """Matrix from the states to z, (outputs z, n)."""
        return self.system.c[:-1]

    @property
    def c2(self) -> np.ndarray:
        """Matrix from the states to v, (1, n)."""
        return self.system.c[-1:]

    @property
    def d11(self) -> np.ndarray:
        """Feedthrough from w to z, (outputs z, inputs w)."""
        return self.system.d[:-1, :-1]

    @property
    def d12(self) -> np.ndarray:
        """Feedthrough from u to z, (outputs z, 1)."""
        return self.system.d[:-1, -1:]

    @property
    def d21(self) -> np.ndarray:
        """Feedthrough from w to v, (1, inputs w)."""
        return self.system.d[-1:, :-1]

    @property
    def d22(self) -> np.ndarray:
        """Feedthrough from u to v, (1, 1)."""
        return self.system.d[-1:, -1:]

    def require_solvable(self) -> None:
        """Check the assumptions of the synthesis; raise DdctError that names the violated one."""
        _require_all_moved(self.system.a, self.b2, 'stabilisable', 'moved by the control')
        _require_all_moved(self.system.a.T, self.c2.T, 'detectable', 'visible in the measurements')
        if not np.any(self.d12):
            raise DdctError(
                'generalised plant: no external output has the control in it directly (D12 is 0), '
                'so that infinite gain costs nothing: weigh the torque, or give W_2 as many zeros '
                'as the plant has more poles than zeros',
                key='W_2',
            )
        if not np.any(self.d21):
            raise DdctError(
                'generalised plant: no external input is in the measurement directly (D21 is 0): '
                'let the reference, or noise, enter the slip error',
                key='reference',
            )

    def close(self, controller: StateSpace) -> StateSpace:
        """Return T_wz with u = controller v; the states of the plant come first."""
        k = controller
        through = np.linalg.inv(np.eye(1) - k.d @ self.d22)
        u_of_x = np.hstack([through @ k.d @ self.c2, through @ k.c])
        u_of_w = through @ k.d @ self.d21
        v_of_x = np.hstack([self.c2, np.zeros((1, len(k.a)))]) + self.d22 @ u_of_x
        v_of_w = self.d21 + self.d22 @ u_of_w
        a = scipy.linalg.block_diag(self.system.a, k.a)
        a += np.vstack([self.b2 @ u_of_x, k.b @ v_of_x])
        c = np.hstack([self.c1, np.zeros((len(self.c1), len(k.a)))]) + self.d12 @ u_of_x
        b = np.vstack([self.b1 + self.b2 @ u_of_w, k.b @ v_of_w])
        return StateSpace(a, b, c, self.d11 + self.d12 @ u_of_w)


def _require_all_moved(a: np.ndarray, b: np.ndarray, property_name: str, what: str) -> None:
    """Check [a - lambda, b] has full rank for every eigenvalue on or right of the axis."""
    for eigenvalue in np.linalg.eigvals(a):
        if eigenvalue.real < 0.0:
            continue
        pencil = np.hstack([a - eigenvalue * np.eye(len(a)), b])
        largest = np.abs(pencil).max(axis=1, keepdims=True)
        scaled = pencil / np.where(largest == 0.0, 1.0, largest)
        sizes = np.linalg.svd(scaled, compute_uv=False)
        if sizes[-1] <= _RANK * sizes[0]:
            raise DdctError(
                f'generalised plant is not {property_name}: its mode at {eigenvalue:.4g} rad/s '
                f'is not {what}: take unstable poles out of the weights and cancelled ones out of '
                'the plant',
                key=property_name,
            )


def balanced(plant: GeneralisedPlant, discount: float = DISCOUNT_RAD_S) -> GeneralisedPlant:
    """
    Return the plant in coordinates whose Gramians, discounted at a rate in rad/s, are equal.

    X and Y of the Riccati equations shrink from 1e16 to some hundreds by it, and so do R and S of
    the LMIs. The discount keeps modes near the axis, whose Gramians are huge, from dominating. A
    plant with modes that are not controllable or not observable is returned unchanged.
    """
    system = plant.system
    _, diagonal = scipy.linalg.matrix_balance(system.a, permute=False)
    scaled = _in_coordinates(system, diagonal)
    fastest_growth = max(float(np.max(np.linalg.eigvals(scaled.a).real)), 0.0)
    decaying = scaled.a - (discount + fastest_growth) * np.eye(len(scaled.a))
    control = float(np.linalg.norm(plant.d12))
    inputs = np.hstack([scaled.b[:, :-1], scaled.b[:, -1:] / control])
    try:
        reach = scipy.linalg.solve_continuous_lyapunov(decaying, -inputs @ inputs.T)
        observe = scipy.linalg.solve_continuous_lyapunov(decaying.T, -scaled.c.T @ scaled.c)
        root = scipy.linalg.cholesky((reach + reach.T) / 2.0, lower=True)
        vectors, values, _ = np.linalg.svd(root.T @ observe @ root)
        # Roots, not a power, whose rounding in numpy depends on the processor.
        fourth_roots = np.sqrt(np.sqrt(values))
        return GeneralisedPlant(_in_coordinates(scaled, root @ vectors / fourth_roots))
    except (np.linalg.LinAlgError, ValueError):
        return plant


def _in_coordinates(system: StateSpace, t: np.ndarray) -> StateSpace:
    """Return the system with x = t times the new state."""
    return StateSpace(
        np.linalg.solve(t, system.a @ t), np.linalg.solve(t, system.b), system.c @ t, system.d
    )
