"""H-infinity synthesis by gamma-iteration: nothing is accepted that the closed loop denies."""

import math
from dataclasses import dataclass

import numpy as np

from ddct_controllers.design.h_infinity.synthesis.generalised_plant import (
    GeneralisedPlant,
    balanced,
)
from ddct_controllers.design.h_infinity.synthesis.norm import h_infinity_norm
from ddct_controllers.design.h_infinity.synthesis.riccati import (
    central_controller,
    stabilising_solutions,
)
from ddct_plant.base.checks import require_number
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.linear.lti import StateSpace

BACK_OFF = 1.01
"""
How far above the optimum the controller is made by default.

At the optimum its fastest pole runs off to infinity; 1 % above it is at some 200 rad/s, and
nothing is left to be cleaned there.
"""
_TOLERANCE = 1e-4
"""Relative width of the last interval of the iteration."""
_AGREEMENT = 1e-6
"""Relative excess of the closed loop's norm over the level that rounding may cause."""
_FACTOR = 4.0
_LOWEST, _HIGHEST = 1e-6, 1e6
"""Levels between which an optimum is looked for."""


class SynthesisError(DdctError):
    """No controller was found whose closed loop could be verified."""


@dataclass(frozen=True, eq=False)
class Synthesis:
    """A controller, and the norms that its closed loop was found to have."""

    controller: StateSpace
    """From v to u, continuous."""
    gamma: float
    """||T_wz|| of the loop with this controller, computed from the closed loop."""
    optimum: float
    """Least ||T_wz|| that a verified controller reached."""
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
    norm; what the Riccati solutions promise does not count. Raise GeneralisedPlantError for a
    plant without a solution, SynthesisError when no level verifies.
    """
    require_back_off(back_off)
    plant.require_solvable()
    plant = balanced(plant)
    best = _first_reached(plant)
    refused = best.gamma / _FACTOR
    while refused > _LOWEST and (better := _reached(plant, refused)):
        best, refused = better, better.gamma / _FACTOR
    while best.gamma > refused * (1.0 + _TOLERANCE):
        middle = math.sqrt(best.gamma * refused)
        better = _reached(plant, middle)
        if better:
            best = better
        else:
            refused = middle
    chosen = _reached(plant, best.gamma * back_off) or best
    return Synthesis(chosen.controller, chosen.gamma, best.gamma, refused, 'riccati')


def require_back_off(back_off: float) -> None:
    """Raise ParameterError for a factor below 1."""
    require_number('back-off from the optimum', back_off, at_least=1.0, at_most=100.0)


@dataclass(frozen=True, eq=False)
class _Reached:
    controller: StateSpace
    gamma: float


def _first_reached(plant: GeneralisedPlant) -> _Reached:
    level = 1.0
    while level <= _HIGHEST:
        found = _reached(plant, level)
        if found:
            return found
        level *= _FACTOR
    raise SynthesisError(
        f'synthesis: no level up to {_HIGHEST:g} gave a controller whose closed loop verifies: '
        'move plant poles and zeros off the imaginary axis, or scale the weights to about 1 near '
        'the crossover'
    )


def _reached(plant: GeneralisedPlant, gamma: float) -> _Reached | None:
    try:
        controller = central_controller(plant, gamma, *stabilising_solutions(plant, gamma))
    except (np.linalg.LinAlgError, ParameterError):
        return None
    norm = verified_norm(plant, controller)
    return _Reached(controller, norm) if norm <= gamma * (1.0 + _AGREEMENT) else None
