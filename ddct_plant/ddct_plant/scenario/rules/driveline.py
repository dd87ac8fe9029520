# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Drivelines that can be integrated, and the parameter that is least usual in one that cannot."""

import math

from ddct_plant.base.clutch_kinds import STICK_SLIP
from ddct_plant.base.errors import ParameterError
from ddct_plant.friction.engagements import one_clutch, one_clutch_system
from ddct_plant.models.parameters import DrivelineParameters

_SMALLEST, _LARGEST = 1e-12, 1e12
"""Magnitudes in SI units far beyond those of any driveline, between which nothing overflows."""


def require_driveline(parameters: DrivelineParameters, clutch: str) -> None:
    """
    Raise ParameterError with a key for a driveline that cannot be integrated.

    That is so with either clutch if clutch and wheels cannot stick together, as H_S G_S is
    singular; with the stick-slip clutch also if its rates are too fast for the pieces of 1 ms.
    """
    try:
        if clutch == STICK_SLIP:
            one_clutch(parameters)
        elif not _usual(parameters):
            one_clutch_system(parameters)
    except (ParameterError, ArithmeticError) as error:
        raise ParameterError(
            f'{least_usual(parameters)}: give inertias, damping and stiffness of a car ({error})',
            key=least_usual(parameters).partition(' ')[0],
        ) from error


def _usual(parameters: DrivelineParameters) -> bool:
    """
    Return whether H_S G_S, which is -diag(1/J_m + 1/J_p, 1/J_v), is regular by its magnitudes.

    Between them no entry of the system and no determinant is rounded to zero or infinity.
    """
    # Inertias and the ratio are positive; a damping may be zero.
    values = parameters.values().values()
    return all(value == 0.0 or _SMALLEST <= value <= _LARGEST for value in values)


def least_usual(parameters: DrivelineParameters) -> str:
    """Return key and value of the parameter farthest from its default."""
    values, usual = parameters.values(), DrivelineParameters().values()
    distances = {
        name: abs(math.log(value) - math.log(usual[name]))
        for name, value in values.items()
        if usual[name] > 0.0 and value > 0.0
    }
    name = max(distances, key=lambda name: distances[name])
    if name == 'total_ratio':
        return f'gear has the total ratio {values[name]:g}'
    return f'{parameters.prefix}{name} is {values[name]:g}'
