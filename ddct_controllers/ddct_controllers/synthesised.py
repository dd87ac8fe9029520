# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Our own H-infinity controllers, synthesised when they are requested."""

from functools import lru_cache
from typing import TYPE_CHECKING

from ddct_plant.base.errors import DdctError
from ddct_plant.models.parameters import DrivelineParameters

if TYPE_CHECKING:
    from ddct_controllers.design.h_infinity.design import HinfDesign

SYNTHESISED = {'hinf_thesis': 'thesis', 'hinf_fitted': 'fitted', 'hinf_sampled': 'sampled'}
"""Recipes of the weights by registry name, for 8 % overshoot and 0.3 s of Section 3.2."""
IDENTIFIED = DrivelineParameters()


def synthesised_design(name: str, driveline: DrivelineParameters = IDENTIFIED) -> 'HinfDesign':
    """
    Return the design of a registry name for a driveline; equal in every process.

    Raise DdctError where the driveline has no such controller.
    """
    try:
        return _designed(SYNTHESISED[name], driveline)
    except DdctError as error:
        if driveline == IDENTIFIED:
            raise
        raise DdctError(
            f"controller {name!r} cannot be computed for the scenario's driveline: {error}; "
            'or choose another controller',
            key=name,
        ) from error


@lru_cache(maxsize=8 * len(SYNTHESISED))
def _designed(recipe: str, driveline: DrivelineParameters) -> 'HinfDesign':
    # Only here: who runs another controller need not wait for the imports of the synthesis.
    from ddct_controllers.design.h_infinity.design import design_h_infinity
    from ddct_controllers.design.h_infinity.recipes import make_weights

    return design_h_infinity(make_weights(recipe), driveline)
