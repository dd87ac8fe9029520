"""State coordinates in which the synthesis of a generalised plant is well conditioned."""

import numpy as np
from scipy.linalg import cholesky, matrix_balance, solve_continuous_lyapunov

from ddct_controllers.design.h_infinity.synthesis.generalised_plant import GeneralisedPlant
from ddct_plant.linear.lti import StateSpace

DISCOUNT_RAD_S = 30.0
"""Decay rate of the Gramians, about the bandwidth of W_t."""


def balanced(plant: GeneralisedPlant, discount: float = DISCOUNT_RAD_S) -> GeneralisedPlant:
    """
    Return the plant in coordinates whose Gramians, discounted at a rate in rad/s, are equal.

    X and Y of the Riccati equations shrink from 1e16 to some hundreds by it, and R and S of the
    LMIs likewise. The discount keeps modes near the axis, whose Gramians are huge, from
    dominating. A plant with modes that nothing moves or shows is returned as it is.
    """
    system = plant.system
    _, diagonal = matrix_balance(system.a, permute=False)
    scaled = _in_coordinates(system, diagonal)
    fastest_growth = max(float(np.max(np.linalg.eigvals(scaled.a).real)), 0.0)
    decaying = scaled.a - (discount + fastest_growth) * np.eye(len(scaled.a))
    control = float(np.linalg.norm(plant.d12))
    inputs = np.hstack([scaled.b[:, :-1], scaled.b[:, -1:] / control])
    try:
        reach = solve_continuous_lyapunov(decaying, -inputs @ inputs.T)
        observe = solve_continuous_lyapunov(decaying.T, -scaled.c.T @ scaled.c)
        root = cholesky((reach + reach.T) / 2.0, lower=True)
        vectors, values, _ = np.linalg.svd(root.T @ observe @ root)
        return GeneralisedPlant(_in_coordinates(scaled, root @ vectors * values**-0.25))
    except (np.linalg.LinAlgError, ValueError):
        return plant


def _in_coordinates(system: StateSpace, t: np.ndarray) -> StateSpace:
    """Return the system with x = t times the new state."""
    return StateSpace(
        np.linalg.solve(t, system.a @ t), np.linalg.solve(t, system.b), system.c @ t, system.d
    )
