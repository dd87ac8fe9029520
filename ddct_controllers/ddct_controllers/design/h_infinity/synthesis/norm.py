"""The H-infinity norm of a closed loop: what every controller is accepted or refused by."""

import math

import numpy as np

from ddct_plant.linear.lti import StateSpace

_TOLERANCE = 1e-7
"""Relative: the norm is at least what is returned and at most this much higher."""
_ON_AXIS = 1e-7
"""Real part, relative to the magnitude, below which an eigenvalue may be on the axis."""
_ROUNDS = 50


def h_infinity_norm(system: StateSpace) -> float:
    """
    Return the largest singular value of a continuous system over frequency; inf if unstable.

    Bruinsma and Steinbuch's method: a frequency response gives a lower bound g; where the
    Hamiltonian matrix of g (1 + tolerance) has eigenvalues on the imaginary axis, the response
    crosses that level, and between two crossings there is a higher one. Without a crossing g is
    the norm. Eigenvalues that might be on the axis only cost time, as the response decides.
    """
    poles = np.linalg.eigvals(system.a)
    if np.any(poles.real >= 0.0):
        return math.inf
    trial = np.concatenate([[0.0], np.abs(poles), np.abs(poles.imag)])
    norm = max(float(np.linalg.norm(system.d, 2)), _highest(system, trial))
    if norm == 0.0:
        return 0.0
    for _ in range(_ROUNDS):
        level = norm * (1.0 + _TOLERANCE)
        crossings = _crossings(system, level)
        if not crossings.size:
            return norm
        middles = np.sqrt(crossings[1:] * crossings[:-1])
        higher = _highest(system, np.concatenate([crossings, middles]))
        if higher <= level:
            return max(norm, higher)
        norm = higher
    return norm


def _highest(system: StateSpace, omega: np.ndarray) -> float:
    """Return the largest singular value at frequencies in rad/s."""
    resolvent = 1j * omega.reshape(-1, 1, 1) * np.eye(len(system.a)) - system.a
    states = np.linalg.solve(resolvent, np.broadcast_to(system.b, (omega.size, *system.b.shape)))
    return float(np.linalg.norm(system.c @ states + system.d, 2, axis=(1, 2)).max())


def _crossings(system: StateSpace, level: float) -> np.ndarray:
    """Return the frequencies in rad/s, rising, at which a singular value may be `level`."""
    a, b, c, d = system.a, system.b, system.c, system.d
    inputs = np.linalg.inv(level**2 * np.eye(b.shape[1]) - d.T @ d)
    drift = a + b @ inputs @ d.T @ c
    coupling = c.T @ (np.eye(len(c)) + d @ inputs @ d.T) @ c
    hamiltonian = np.block([[drift, b @ inputs @ b.T], [-coupling, -drift.T]])
    found = np.linalg.eigvals(hamiltonian)
    near = np.abs(found.real) <= _ON_AXIS * np.abs(found)
    return np.unique(np.abs(found[near].imag))
