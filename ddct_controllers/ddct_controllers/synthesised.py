# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Our own H-infinity controllers, synthesised when they are requested."""

from functools import lru_cache
from typing import TYPE_CHECKING

from ddct_plant.base.errors import DdctError
from ddct_plant.models.actuator import PRINTED_ACTUATOR, ActuatorParameters
from ddct_plant.models.parameters import DrivelineParameters

if TYPE_CHECKING:
    from ddct_controllers.design.h_infinity.design import HinfDesign

SAMPLED = 'hinf_sampled'
SYNTHESISED = {'hinf_thesis': 'thesis', 'hinf_fitted': 'fitted', SAMPLED: 'sampled'}
"""Recipes of the weights by registry name, for 8 % overshoot and 0.3 s of Section 3.2."""
IDENTIFIED = DrivelineParameters()


def synthesised_design(
    name: str,
    driveline: DrivelineParameters = IDENTIFIED,
    actuator: ActuatorParameters = PRINTED_ACTUATOR,
) -> 'HinfDesign':
    """
    Return the design of a registry name for a driveline; equal in every process.

    `hinf_sampled` is for the actuator too; those with weights of the thesis keep the printed one.
    Raise DdctError where the car has no such controller.
    """
    try:
        known = actuator if name == SAMPLED else PRINTED_ACTUATOR
        return _designed(SYNTHESISED[name], driveline, known)
    except DdctError as error:
        if (driveline, actuator) == (IDENTIFIED, PRINTED_ACTUATOR):
            raise
        raise DdctError(
            f"controller {name!r} cannot be computed for the scenario's driveline and actuator: "
            f'{error}; or choose another controller',
            key=name,
        ) from error


@lru_cache(maxsize=8 * len(SYNTHESISED))
def _designed(
    recipe: str, driveline: DrivelineParameters, actuator: ActuatorParameters
) -> 'HinfDesign':
    # Only here: who runs another controller need not wait for the imports of the synthesis.
    from ddct_controllers.design.h_infinity.design import design_h_infinity
    from ddct_controllers.design.h_infinity.recipes import make_weights

    return design_h_infinity(make_weights(recipe), driveline, actuator=actuator)
