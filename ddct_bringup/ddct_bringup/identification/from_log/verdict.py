# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Reasons for which a fit to a log is refused, and notes on an accepted one."""

from collections.abc import Collection, Iterator, Sequence

import numpy as np

from ddct_bringup.identification.from_log.prediction import SpeedPrediction
from ddct_bringup.identification.from_log.result import LogFit
from ddct_bringup.identification.from_log.stretches import (
    FEWEST_SAMPLES,
    INPUTS,
    LOAD,
    TORQUES,
    Stretch,
)
from ddct_bringup.identification.from_log.unknowns import DAMPINGS
from ddct_bringup.logs.columns import MOST_DELAY_S
from ddct_bringup.logs.log import SPEEDS

USUAL = {
    'engine_inertia': (0.05, 1.0),
    'shaft_inertia': (0.001, 0.1),
    'halfshaft_damping': (1.0, 5000.0),
    'halfshaft_stiffness': (500.0, 100_000.0),
    'total_ratio': (2.0, 25.0),
    'vehicle_inertia': (40.0, 800.0),
}
"""Ranges of cars, in SI units, by parameter; a value outside is probably in other units."""
MOST_DAMPING = 1.0
"""Largest damping of engine or shaft in N m s/rad: 200 N m at 2000 rpm."""
ENGINE_RAD_S = (40.0, 800.0)
"""Least and largest median speed of a car's engine: from a stall at 380 rpm to 7600 rpm."""
MOST_ERROR = 0.1
"""Largest r.m.s. of a prediction without noise, over the standard deviation of the speed."""
NEGATIVE_SIGMAS = 3.0
"""Standard deviations below 0 at which a damping counts as negative: chance gives one in 700."""
NO_DAMPING = 1e-6
"""Damping in N m s/rad that counts as zero: 0.001 N m at 1000 rad/s."""
LEAD_S = 0.02
"""Largest lead in s of C_f over C_m: beyond it C_f is probably a request."""
_AT_BOUND = 0.99
_SMOOTHED = 5
"""Samples over which acceleration and torque are averaged to detect a wrong sign."""
_FOLLOWS = 0.5
"""Negative correlation of the engine's acceleration with C_m - C_f that means a wrong sign."""
_LOCKED = 0.01
"""Largest slip of plates that count as locked, over the engine speed."""
_EXCESS = 0.05
"""Least excess of C_f over C_m that noise does not explain, over the largest C_m."""
_OFTEN = 0.25
"""Share of the samples with this excess that no delay of a column explains."""


def reasons_against(
    fit: LogFit, predictions: Sequence[SpeedPrediction], stretches: Sequence[Stretch]
) -> list[str]:
    """Return the reasons to refuse a fit to `stretches`, as sentences; none to accept it."""
    return [
        *reasons_in_log(stretches),
        *_error_reasons(predictions, fit.undetermined),
        *_parameter_reasons(fit),
    ]


def reasons_in_log(stretches: Sequence[Stretch]) -> list[str]:
    """Return the reasons that need no fit, as sentences."""
    return [
        *_speed_reasons(stretches),
        *_capacity_reasons(stretches),
        *_sign_reasons(stretches),
    ]


def _speed_reasons(stretches: Sequence[Stretch]) -> Iterator[str]:
    median = float(np.median(np.concatenate([each.speeds[:, 0] for each in stretches])))
    lowest, highest = ENGINE_RAD_S
    if not lowest <= median <= highest:
        yield (
            f'engine_speed is {median:.4g} rad/s ({median * 30.0 / np.pi:.4g} rpm) in the middle, '
            f'of cars it is {lowest:g} to {highest:g} rad/s: check its unit'
        )


def _capacity_reasons(stretches: Sequence[Stretch]) -> Iterator[str]:
    """Detect a C_f above C_m in locked plates while the engine speeds up by its own torque."""
    engine, clutch = np.concatenate([_accelerating_locked(each) for each in stretches], axis=1)
    if len(engine) < FEWEST_SAMPLES:
        return
    excess = clutch - engine
    wrong = excess > _EXCESS * engine.max()
    if wrong.mean() > _OFTEN:
        yield (
            f'while the plates are locked and the engine speeds up, {TORQUES[1]} exceeds '
            f'{TORQUES[0]} by {np.median(excess[wrong]):.3g} N m: is it the capacity or the '
            'request of the clutch, not the torque that it transmits, or are the two swapped?'
        )


def _accelerating_locked(stretch: Stretch) -> np.ndarray:
    """Return C_m and C_f in N m where locked plates speed up and C_m drives, (2, m)."""
    speed, shaft = stretch.speeds[:, 0], stretch.speeds[:, 1]
    torques = stretch.torques[:, INPUTS.places(*TORQUES)].T
    engine, clutch = (np.interp(stretch.time_s, stretch.grid_s, each) for each in torques)
    smooth = np.ones(_SMOOTHED) / _SMOOTHED
    accel = np.convolve(np.gradient(speed, stretch.time_s), smooth, 'same')
    locked = np.abs(speed - shaft) <= _LOCKED * speed
    return np.stack([engine, clutch])[:, locked & (accel > 0.0) & (engine > 0.0)]


def _sign_reasons(stretches: Sequence[Stretch]) -> Iterator[str]:
    """Compare the sign of the engine's acceleration with that of C_m - C_f."""
    work = [(np.diff(each.speeds[:, 0]), np.diff(_impulse(each))) for each in stretches]
    change, impulse = (np.concatenate(parts) for parts in zip(*work, strict=True))
    smooth = np.ones(_SMOOTHED) / _SMOOTHED
    smoothed = [np.convolve(each, smooth, 'valid') for each in (change, impulse)]
    if not all(each.std() for each in smoothed):
        return
    correlation = float(np.corrcoef(smoothed[0], smoothed[1])[0, 1])
    if correlation < -_FOLLOWS:
        yield (
            f'the engine slows down where {TORQUES[0]} exceeds {TORQUES[1]} (correlation '
            f'{correlation:.2f}): are the two columns swapped, or is a sign wrong?'
        )


def _impulse(stretch: Stretch) -> np.ndarray:
    """Return the integral of C_m - C_f over time in N m s at the samples, (n,)."""
    step = stretch.grid_s[1] - stretch.grid_s[0]
    engine, clutch = stretch.torques[:, INPUTS.places(*TORQUES)].T
    return np.interp(stretch.time_s, stretch.grid_s, np.cumsum(engine - clutch) * step)


def _error_reasons(
    predictions: Sequence[SpeedPrediction], undetermined: Collection[str]
) -> Iterator[str]:
    kept = ', '.join(sorted({*undetermined} & USUAL.keys()))
    advice = f'; the log does not determine {kept}: give a log that does' if kept else ''
    for each in predictions:
        if each.error > MOST_ERROR:
            yield (
                f'the held-out {each.signal} is missed by {each.rms_rad_s:.3g} rad/s r.m.s., '
                f'{100.0 * each.error:.3g} % of its deviation beyond noise (at most '
                f'{100.0 * MOST_ERROR:g} %){advice}'
            )


def _parameter_reasons(fit: LogFit) -> Iterator[str]:
    for name in fit.std:
        value = fit.values[name]
        lowest, highest = fit.interval(name) or (value, value)
        interval = f'{name} is {value:.4g} ({lowest:.4g} to {highest:.4g})'
        if name in DAMPINGS and value < -NEGATIVE_SIGMAS * fit.std[name]:
            yield f'{interval}: a damping cannot be negative'
        elif name in DAMPINGS and lowest > MOST_DAMPING:
            yield f'{interval}: of cars it is below {MOST_DAMPING:g}: check the units'
        elif name in USUAL and not USUAL[name][0] <= value <= USUAL[name][1]:
            low, high = USUAL[name]
            yield f'{interval}, of cars it is {low:g} to {high:g}: check the units of the columns'
    for name in fit.delay_std:
        if abs(fit.delays[name]) > _AT_BOUND * MOST_DELAY_S:
            yield (
                f'the delay of {name} is beyond {1e3 * MOST_DELAY_S:g} ms: shift the column, or '
                'check that it belongs to this drive'
            )


def doubts(fit: LogFit, predictions: Sequence[SpeedPrediction]) -> list[str]:
    """Return notes on the limits of a fit, as sentences."""
    return [
        *_undetermined(fit),
        *_still(predictions),
        *_zeroed(fit),
        *_leading(fit),
    ]


def _undetermined(fit: LogFit) -> Iterator[str]:
    if fit.undetermined:
        yield (
            f'the log does not determine {", ".join(_named(each) for each in fit.undetermined)}: '
            'what the car has of them stays, a delay is taken as 0, and the other intervals hold '
            'for these values'
        )


def _named(name: str) -> str:
    return f'the delay of {name}' if name in (*SPEEDS, *TORQUES, LOAD) else name


def _still(predictions: Sequence[SpeedPrediction]) -> Iterator[str]:
    for each in predictions:
        if each.no_nrmse:
            yield f'the held-out {each.signal} has no NRMSE: {each.no_nrmse}'


def _zeroed(fit: LogFit) -> Iterator[str]:
    for name in DAMPINGS:
        if name in fit.std and fit.values[name] < -NO_DAMPING:
            yield f'{name} is {fit.values[name]:.3g}, and the new car has 0'


def _leading(fit: LogFit) -> Iterator[str]:
    """Detect a clutch torque that is requested rather than transmitted."""
    ahead = fit.delays[TORQUES[0]] - fit.delays[TORQUES[1]]
    if ahead > LEAD_S:
        yield (
            f'{TORQUES[1]} is {1e3 * ahead:.3g} ms ahead of {TORQUES[0]}: if it is a request, its '
            'delay is that of the actuator, whose dynamics the model lacks; log the torque that '
            'is transmitted'
        )
