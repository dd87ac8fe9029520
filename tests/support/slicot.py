# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""H-infinity synthesis by SLICOT's sb10ad through slycot."""

import math
from typing import Any

import numpy as np

from ddct_controllers.design.h_infinity.synthesis.gamma_iteration import verified_norm
from ddct_controllers.design.h_infinity.synthesis.generalised_plant import GeneralisedPlant
from ddct_plant.base.errors import ParameterError
from ddct_plant.linear.lti import StateSpace

_TOLERANCE = 1e-4
"""Relative width of the last interval of the bisection, as in our synthesis."""
_SUBOPTIMAL = 4
"""Value of the argument `job` of sb10ad: one controller for a given level."""
_FACTOR = 4.0


def slycot_optimum(slycot: Any, plant: GeneralisedPlant) -> float:
    """Return the least norm that a verified controller of sb10ad reaches."""
    best = 1.0
    while not math.isfinite(reached := _reached(slycot, plant, best)):
        best *= _FACTOR
    best, refused = reached, 0.5 * reached
    while best > refused * (1.0 + _TOLERANCE):
        middle = math.sqrt(best * refused)
        reached = _reached(slycot, plant, middle)
        if math.isfinite(reached):
            best = min(best, reached)
        else:
            refused = middle
    return best


def _reached(slycot: Any, plant: GeneralisedPlant, level: float) -> float:
    """Return the closed loop's norm with sb10ad's controller for a level, inf if above it."""
    system = plant.system
    sizes = (len(system.a), system.b.shape[1], len(system.c), 1, 1)
    matrices = (system.a, system.b, system.c, system.d)
    try:
        found = slycot.sb10ad(*sizes, level, *matrices, job=_SUBOPTIMAL)
        norm = verified_norm(plant, StateSpace(*found[1:5]))
    except (slycot.exceptions.SlycotError, np.linalg.LinAlgError, ParameterError):
        return math.inf
    return norm if norm <= level * (1.0 + _TOLERANCE) else math.inf
