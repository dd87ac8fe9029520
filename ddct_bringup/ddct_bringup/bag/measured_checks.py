# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Check the total ratio, units and signs of another tool's log against its own signals.

A check that the log's signals cannot decide raises nothing.
"""

from collections.abc import Mapping

import numpy as np

from ddct_bringup.logs.wheel_radius import RADII_M
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.gearbox import EngagedGear

Values = Mapping[str, np.ndarray]
"""Samples by quantity name: (N+1,) each, SI units, every 10 ms."""

RATIO_TOLERANCE = 0.01
"""Largest relative error of a given total ratio."""
TWIST_RAD = 0.5
"""Largest twist of the driveshaft with its backlash, rad: tolerance of the turned angles."""
_LEAST_TURNED_RAD = 5.0
"""Least angle that the wheels must have turned for a check of ratio or radius, rad."""
ENGINE_INERTIAS = (0.03, 1.5)
"""Lowest and highest inertia J_m of a car's engine with its flywheel, kg m^2."""
_PER_OTHER_UNIT = {'rpm': 30.0 / np.pi, 'deg/s': 180.0 / np.pi}
"""Factors from rad/s to other units of speeds."""
_SAME_FACTOR = 0.02
"""Largest relative difference of two factors that count as the same."""
_LOCKED_S, _LOCKED_SPREAD = 0.3, 0.05
"""Least time in s with proportional speeds, and least change of the speed in it over the largest
speed, that show a locked clutch and two units."""
_WINDOW_S = 0.1
"""Length in s of the windows over which rates and torques are averaged."""
_SURE, _SURE_OF_SLOPE = 0.9, 10.0
"""Least coefficient of determination, and least slope over its standard deviation, to decide."""


def require_no_contradiction(gear: EngagedGear | None, values: Values) -> None:
    """Raise DdctError, in one line that names the values to mend, where signals disagree."""
    if 'wheel_speed' in values:
        if gear is not None:
            _require_ratio(gear, values)
        _require_radius(values)
    _require_same_unit(values)
    if 'clutch_torque' in values and not ('engine_torque' in values and _engine_fits(values)):
        _require_friction(values)


def _require_ratio(given: EngagedGear, values: Values) -> None:
    """
    Compare the total ratio with the angles that shaft and wheels turned; raise DdctError.

    The clutch has no part in it: locked or slipping, the angles differ by the driveshaft's
    twist.
    """
    shaft, wheels = (PERIOD_S * np.sum(values[name]) for name in ('shaft_speed', 'wheel_speed'))
    if abs(wheels) < _LEAST_TURNED_RAD:
        return
    found, factor = float(shaft / wheels), float(shaft / given.shaft_speed(wheels))
    tolerance = RATIO_TOLERANCE + TWIST_RAD / abs(wheels)
    if abs(factor - 1.0) > tolerance:
        raise DdctError(
            f'run.total_ratio is {given}, but in the log shaft_speed over wheel_speed is '
            f'{found:.4g}, give or take {100.0 * tolerance:.1f} %: give the ratio of the engaged '
            f'gear, or mend {_suspects("shaft_speed", "wheel_speed", factor)}',
            key='run.total_ratio',
        )


def _suspects(first: str, second: str, factor: float) -> str:
    """Return the suspected mistakes in two speeds of which one is `factor` times too large."""
    suspects = f'unit or sign of {first} and {second}'
    for unit, size in _PER_OTHER_UNIT.items():
        if min(abs(abs(factor) / size - 1.0), abs(abs(factor) * size - 1.0)) < 3.0 * _SAME_FACTOR:
            return f'the {suspects} (the factor is that of {unit} to rad/s)'
    return f'the {suspects}'


def _require_radius(values: Values) -> None:
    """Raise DdctError where V_x or A_x over the wheel speed is no radius that wheels have."""
    wheels = values['wheel_speed']
    if 'vehicle_speed' in values and abs(PERIOD_S * np.sum(wheels)) > _LEAST_TURNED_RAD:
        _require_in(
            float(np.sum(values['vehicle_speed']) / np.sum(wheels)),
            RADII_M,
            'vehicle_speed over wheel_speed gives wheels of {:.3g} m radius',
            'vehicle_speed and wheel_speed',
        )
    if 'vehicle_accel' in values:
        changes = np.column_stack([_per_window(values['vehicle_accel'], mean=True)])
        slopes, sure = _slopes(_per_window(wheels, mean=False), changes)
        if sure[0]:
            _require_in(
                float(1.0 / slopes[0]),
                RADII_M,
                'vehicle_accel over the change of wheel_speed gives wheels of {:.3g} m radius',
                'vehicle_accel and wheel_speed',
            )


def _require_same_unit(values: Values) -> None:
    """Raise DdctError where the engine speed is the shaft speed in another unit for some time."""
    engine, shaft = values['engine_speed'], values['shaft_speed']
    for unit, size in _PER_OTHER_UNIT.items():
        for factor in (size, 1.0 / size):
            locked = (shaft != 0.0) & (np.abs(engine - factor * shaft) < 0.01 * np.abs(engine))
            if np.sum(locked) * PERIOD_S > _LOCKED_S and np.ptp(shaft[locked]) > (
                _LOCKED_SPREAD * np.max(np.abs(shaft))
            ):
                raise DdctError(
                    f'engine_speed is {factor:.4g} times shaft_speed for '
                    f'{np.sum(locked) * PERIOD_S:.2g} s, the factor of {unit} to rad/s: mend the '
                    'unit of one of them',
                    key='engine_speed',
                )


def _engine_fits(values: Values) -> bool:
    """
    Compare both torques with J_m dw_m/dt = C_m - C_f; return whether they explain the speed.

    Where they do and no DdctError is raised, the signs are right whatever the slip is.
    """
    torques = np.column_stack(
        [_per_window(values[name], mean=True) for name in ('engine_torque', 'clutch_torque')]
    )
    (of_engine, of_clutch), sure = _slopes(
        _per_window(values['engine_speed'], mean=False), torques
    )
    if not sure.all():
        return False
    for name, slope in (('engine_torque', of_engine), ('clutch_torque', -of_clutch)):
        if slope < 0.0:
            other = 'swap the two columns' if of_engine < 0.0 < of_clutch else 'turn its sign'
            raise DdctError(
                f'{name} has the wrong sign: the engine speeds up by {of_engine:.3g} rad/s^2 per '
                f'N m of engine_torque and by {of_clutch:.3g} per N m of clutch_torque: {other}'
            )
        _require_in(
            float(1.0 / slope),
            ENGINE_INERTIAS,
            f'{name} over the acceleration of engine_speed gives an engine of {{:.3g}} kg m^2',
            f'{name} and engine_speed',
        )
    return True


def _require_friction(values: Values) -> None:
    """Raise DdctError where the clutch gives power; friction takes it: C_f (w_m - w_p) > 0."""
    power = values['clutch_torque'] * (values['engine_speed'] - values['shaft_speed'])
    whole = float(np.sum(np.abs(power)))
    if whole > 0.0 and np.sum(power) < -0.5 * whole:
        raise DdctError(
            'clutch_torque has the sign of a clutch that gives power: '
            f'{-100.0 * np.sum(np.minimum(power, 0.0)) / whole:.0f} % of C_f (w_m - w_p) is below '
            'zero: turn its sign, positive is towards the wheels, or mend the speeds',
            key='clutch_torque',
        )


def _require_in(found: float, bounds: tuple[float, float], text: str, signals: str) -> None:
    """Raise DdctError, which names the signals, unless a quantity of the car is within bounds."""
    if not bounds[0] <= found <= bounds[1]:
        raise DdctError(
            f'{text.format(found)}, a car has {bounds[0]:g} to {bounds[1]:g}: mend the units or '
            f'signs of {signals}'
        )


def _per_window(signal: np.ndarray, *, mean: bool) -> np.ndarray:
    """Return the means, or the mean slopes per s, over the whole windows of 0.1 s of a signal."""
    width = round(_WINDOW_S / PERIOD_S)
    count = (len(signal) - 1) // width
    if mean:
        halves = 0.5 * (signal[1:] + signal[:-1])
        return halves[: count * width].reshape(count, width).mean(axis=1)
    return np.diff(signal[: count * width + 1 : width]) / _WINDOW_S


def _slopes(rates: np.ndarray, causes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the slopes of a least-squares fit with a constant, and whether each is significant.

    None is significant where the causes explain too little of the rates.
    """
    width = causes.shape[1]
    table = np.column_stack([causes, np.ones(len(causes))])
    unsure = np.zeros(width), np.zeros(width, dtype=bool)
    if len(rates) < 2 * table.shape[1] or np.linalg.matrix_rank(table) < table.shape[1]:
        return unsure
    slopes = np.linalg.lstsq(table, rates, rcond=None)[0]
    unexplained = np.sum((rates - table @ slopes) ** 2)
    whole = np.sum((rates - rates.mean()) ** 2)
    if not whole or unexplained > (1.0 - _SURE) * whole:
        return unsure
    variance = unexplained / (len(rates) - table.shape[1])
    std = np.sqrt(variance * np.diag(np.linalg.inv(table.T @ table)))[:width]
    return slopes[:width], np.abs(slopes[:width]) > _SURE_OF_SLOPE * std
