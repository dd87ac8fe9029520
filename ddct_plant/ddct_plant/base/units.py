# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""All conversions between SI units and those of users."""

import math
from collections.abc import Mapping, Sequence
from typing import TypeVar

import numpy as np

from ddct_plant.base.errors import ParameterError

RAD_S_PER_RPM = math.pi / 30.0
RPM_PER_RAD_S = 30.0 / math.pi

_GRADE = '%'
"""Grade of a road: 100 times the tangent of its slope angle."""
_IN_SI: Mapping[str, Mapping[str, float]] = {
    's': {'s': 1.0, 'ms': 1e-3, 'us': 1e-6, 'ns': 1e-9},
    'rad': {'rad': 1.0, 'deg': math.pi / 180.0, _GRADE: math.nan},
    'rad/s': {'rad/s': 1.0, 'rpm': RAD_S_PER_RPM, 'deg/s': math.pi / 180.0},
    'N m': {'N m': 1.0, 'Nm': 1.0, 'kN m': 1e3},
    'm/s': {'m/s': 1.0, 'km/h': 1.0 / 3.6},
    'm/s^2': {'m/s^2': 1.0, 'g': 9.80665},
    '': {'1': 1.0},
}
"""Accepted units of a user's file and their size in the SI unit, by SI unit."""


Speed = TypeVar('Speed', float, np.ndarray)


def rpm_from_rad_s(speed: Speed) -> Speed:
    """Convert a speed (float or array) from rad/s to rpm."""
    return speed * RPM_PER_RAD_S


def rad_s_from_rpm(speed_rpm: Speed) -> Speed:
    """Convert a speed (float or array) from rpm to rad/s."""
    return speed_rpm * RAD_S_PER_RPM


def si_unit_of(unit: object, si_units: Sequence[str]) -> str:
    """Return the first of `si_units` that a user's unit is one of, else raise ParameterError."""
    for si_unit in si_units:
        if isinstance(unit, str) and unit in _IN_SI[si_unit]:
            return si_unit
    units = (name for si_unit in si_units for name in _IN_SI[si_unit])
    raise ParameterError(f'unit {unit!r}: choose from {", ".join(units)}')


def si_values(values: np.ndarray, unit: object, si_unit: str) -> np.ndarray:
    """Convert values of a user's file to `si_unit`; raise ParameterError for an unknown unit."""
    size = _IN_SI[si_unit_of(unit, (si_unit,))][str(unit)]
    return np.arctan(values / 100.0) if unit == _GRADE else values * size
