# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""H-infinity synthesis by gamma-iteration; every controller is verified in the closed loop."""

import math
from dataclasses import dataclass, replace

import numpy as np

from ddct_controllers.design.h_infinity.synthesis.generalised_plant import (
    GeneralisedPlant,
    balanced,
)
from ddct_controllers.design.h_infinity.synthesis.riccati import (
    central_controller,
    stabilising_solutions,
)
from ddct_plant.base.errors import DdctError, ParameterError, require_number
from ddct_plant.linear.lti import StateSpace

BACK_OFF = 1.01
"""
Level of the controller over the optimum, by default, as a factor.

At the optimum its fastest pole runs off to infinity; 1 % above it is at some 200 rad/s, and
nothing is left to be cleaned there.
"""
_TOLERANCE = 1e-4
"""Width of the last interval of the iteration, relative."""
_CLEARLY = 1e-3
"""Width of the grid to which a norm is rounded up, relative."""
_AGREEMENT = 1e-6
"""Excess of the closed loop's norm over the level that rounding may cause, relative."""
_FACTOR = 4.0
_NORM_TOLERANCE = 1e-7
"""Largest excess of the norm over the value returned, which is a lower bound; relative."""
_ON_AXIS = 1e-7
"""Real part, relative to the magnitude, below which an eigenvalue may be on the axis."""
_ROUNDS = 50
_LOWEST, _HIGHEST = 1e-6, 1e6
"""Levels between which the optimum is sought."""


@dataclass(frozen=True, eq=False)
class Synthesis:
    """A controller, and the norms computed from its closed loop."""

    controller: StateSpace
    """Controller from v to u, continuous."""
    gamma: float
    """Norm ||T_wz|| of the loop with this controller, computed from the closed loop."""
    optimum: float
    """Least norm ||T_wz|| that a verified controller reached."""
    lower_bound: float
    """Highest level that was refused; for the LMIs their optimum, to the solver's tolerance."""
    method: str


def verified_norm(plant: GeneralisedPlant, controller: StateSpace) -> float:
    """Return ||T_wz|| of the closed loop, infinite if it is unstable."""
    return h_infinity_norm(plant.close(controller))


def synthesise(plant: GeneralisedPlant, back_off: float = BACK_OFF) -> Synthesis:
    """
    Return the central controller at `back_off` times the least level that verifies.

    A level counts as reached when its controller's closed loop is stable and has at most that
    norm; the Riccati solutions alone do not count. Raise DdctError for a plant without a solution,
    and when no level verifies.
    """
    require_number('back-off from the optimum', back_off, at_least=1.0, at_most=100.0)
    plant.require_solvable()
    plant = balanced(plant)
    level_of = _norm if back_off == 1.0 else _level_free_of_rounding
    tested, best = _first_reached(plant)
    level = level_of(tested, best)
    refused = level / _FACTOR
    while refused > _LOWEST and (better := _reached(plant, refused)):
        level, best = level_of(refused, better), better
        refused = level / _FACTOR
    while level > refused * (1.0 + _TOLERANCE):
        middle = math.sqrt(level * refused)
        better = _reached(plant, middle)
        if better:
            level, best = level_of(middle, better), better
        else:
            refused = middle
    chosen = _reached(plant, level * back_off) or best
    return replace(chosen, optimum=best.gamma, lower_bound=refused)


def _norm(tested: float, found: Synthesis) -> float:
    """Return the norm that was reached, to come as near to the optimum as possible."""
    return found.gamma


def _level_free_of_rounding(tested: float, found: Synthesis) -> float:
    """
    Return the tested level, or the norm that was reached, rounded up, where it is clearly lower.

    Near the optimum a norm has 7 digits, and a controller 1 % above it changes by 100 times the
    change of its level. Levels that follow from norms would make it another one on each processor.
    """
    grid = math.log1p(_CLEARLY)
    return min(tested, math.exp(grid * math.ceil(math.log(found.gamma) / grid)))


def _first_reached(plant: GeneralisedPlant) -> tuple[float, Synthesis]:
    """Return the first level that is reached, and what reaches it."""
    level = 1.0
    while level <= _HIGHEST:
        found = _reached(plant, level)
        if found:
            return level, found
        level *= _FACTOR
    raise DdctError(
        f'no level up to {_HIGHEST:g} gave a controller whose closed loop verifies: '
        'move plant poles and zeros off the imaginary axis, or scale the weights to about 1 near '
        'the crossover',
        key='weights',
    )


def _reached(plant: GeneralisedPlant, gamma: float) -> Synthesis | None:
    """Return the central controller for a level if the norm of its closed loop is within it."""
    try:
        controller = central_controller(plant, gamma, *stabilising_solutions(plant, gamma))
    except (np.linalg.LinAlgError, ParameterError):
        return None
    norm = verified_norm(plant, controller)
    found = Synthesis(controller, norm, norm, 0.0, 'riccati')
    return found if norm <= gamma * (1.0 + _AGREEMENT) else None


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
        level = norm * (1.0 + _NORM_TOLERANCE)
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
