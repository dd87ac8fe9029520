# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""From specifications to a loop-shaping controller that is verified in the sampled loop."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from ddct_controllers.design.loop_shaping.candidates import Candidates
from ddct_controllers.design.loop_shaping.specifications import (
    TimeSpecifications,
    require_reachable,
)
from ddct_controllers.design.loop_shaping.verification import LoopVerification, verify
from ddct_plant.base.errors import ParameterError
from ddct_plant.linear.lti import FactoredTransferFunction
from ddct_plant.models.actuator import PRINTED_ACTUATOR, ActuatorParameters
from ddct_plant.models.parameters import DrivelineParameters

STRUCTURES = ('networks', 'placement')
"""
Names of the structures: integrators with lead networks, as G_c1 begins, or placement.

The latter has placed poles and zeros, as G_c2.
"""


@dataclass(frozen=True)
class LoopShapingDesign:
    """A controller that meets its specifications in the sampled loop."""

    structure: str
    """Name of the structure, one of STRUCTURES."""
    integrators: int
    """Number mu of integrators."""
    controller: FactoredTransferFunction
    verification: LoopVerification


def design_loop_shaping(
    specifications: TimeSpecifications,
    integrator_count: int,
    parameters: DrivelineParameters,
    structures: tuple[str, ...] = STRUCTURES,
    actuator: ActuatorParameters = PRINTED_ACTUATOR,
) -> LoopShapingDesign:
    """
    Return the slowest controller found that meets the specifications.

    In this order: a structure whose L stays out of the S_p and T_p curves, then any that meets the
    time specifications. Only controllers that `verify` accepts are returned. Without one raise
    ParameterError with the specifications that can be reached.
    """
    require_reachable(specifications)
    candidates = Candidates(specifications, integrator_count, parameters, actuator)
    rejections: tuple[str, ...] = ()
    for within_contours in (True, False):
        for structure in structures:
            for controller in candidates.fast_enough(structure, within_contours):
                found = verify(controller, specifications, parameters, actuator)
                if not found.rejections and found.respects_contours >= within_contours:
                    return LoopShapingDesign(structure, integrator_count, controller, found)
                rejections = found.rejections
    raise _failure(specifications, integrator_count, candidates.fastest_s(structures), rejections)


def _failure(
    specifications: TimeSpecifications,
    integrator_count: int,
    fastest_s: float,
    rejections: Sequence[str],
) -> ParameterError:
    """
    Return the error with the reachable specifications and the remedy.

    `fastest_s` is the shortest rise time in s of all candidates, inf without one; `rejections` are
    the reasons against the last candidate that was fast enough.
    """
    limit_s = specifications.rise_time_s
    goal = (
        f'no loop-shaping controller found with {integrator_count} integrator(s), rise time '
        f'{limit_s:g} s and overshoot {100.0 * specifications.overshoot:g} % in the '
        'sampled loop'
    )
    if fastest_s <= limit_s:
        return ParameterError(
            f'{goal} (last candidate: {"; ".join(rejections)}): allow a longer rise time',
            key='rise time',
        )
    if math.isinf(fastest_s):
        return ParameterError(f'{goal}, nor a slower one: allow more overshoot', key='overshoot')
    fastest_s = math.ceil(1000.0 * fastest_s) / 1000.0
    return ParameterError(
        f'{goal}: the fastest has {fastest_s:g} s: allow that or more overshoot', key='rise time'
    )
