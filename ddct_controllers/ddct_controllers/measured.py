# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Check of a measurement before a controller stores any of it."""

import math
from collections.abc import Iterable

from ddct_controllers.interface import Measurement
from ddct_plant.base.errors import DdctError

MOST = 1e9
"""Largest size of a signal, in its SI unit; far beyond any vehicle."""
_UNITS = {
    'engine_speed': 'rad/s',
    'shaft_speed': 'rad/s',
    'wheel_speed': 'rad/s',
    'engine_torque': 'N m',
    'load_torque': 'N m',
    'open_loop_torque': 'N m',
    'slip_reference': 'rad/s',
    'slip_reference_rate': 'rad/s^2',
}


def measured_speeds(measurement: Measurement) -> tuple[float, float, float]:
    """
    Return w_m, w_p, w_r in rad/s after a check of the whole measurement.

    Raise DdctError that names the first number that is not finite or larger than MOST, among them,
    the torques and the references.
    """
    speeds = (measurement.engine_speed, measurement.shaft_speed, measurement.wheel_speed)
    # One call at every step: what is within MOST together is so each by itself.
    together = math.hypot(
        *speeds,
        measurement.engine_torque,
        measurement.load_torque,
        measurement.open_loop_torque,
        *measurement.slip_reference,
        *measurement.slip_reference_rate,
    )
    if not together <= MOST:
        _require_each(measurement)
    return speeds


def _require_each(measurement: Measurement) -> None:
    for name, unit in _UNITS.items():
        values = getattr(measurement, name)
        listed = isinstance(values, Iterable)
        for ahead, value in enumerate(values if listed else (values,)):
            if not abs(value) <= MOST:
                what = f'{name}[{ahead}]' if listed else name
                raise DdctError(
                    f'{what} is {value:g} {unit} at step {measurement.step}, not a number within '
                    f'+-{MOST:g}: mend what gives it, or the loop if it diverges',
                    key=what,
                )
