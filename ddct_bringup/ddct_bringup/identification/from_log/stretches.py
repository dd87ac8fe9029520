# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Cut a log into stretches without gaps, with the torques on one grid."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ddct_bringup.identification.from_log.stretch import LOAD, SPEED_COLUMNS, TORQUES, Stretch
from ddct_bringup.logs.columns import MOST_DELAY_S, TIME
from ddct_bringup.logs.log import SPEEDS, MeasuredLog, between
from ddct_plant.base.errors import DdctError

FEWEST_SAMPLES = 40
"""Fewest samples of a stretch: 0.4 s at 100 Hz, just over a period of the locked driveline."""
SAMPLING_S = (1e-4, 0.1)
"""Shortest and longest sampling period of a signal; of others the unit of the time is wrong."""
_GAP = 5.0
"""Shortest gap, in median steps of a signal."""
_UNEVEN = 0.02
"""Largest deviation of equal steps, over the median step."""
_FINEST = 20
"""Most grid steps in one step of the speeds."""
_NOISY = 1e-3
"""White noise of a torque over its standard deviation, below which a fit is not affected."""
_FOR_UNEVEN = 4
"""Grid steps in the median step of the speeds where their steps are not equal."""
_MEDIAN = 0.6745
"""Median of the magnitude of a standard normal number."""
KnownLoad = Callable[[np.ndarray], np.ndarray]
"""Function from wheel speeds in rad/s to the known part of C_load in N m, (n,) each."""


def stretches_of(log: MeasuredLog, known_load: KnownLoad) -> list[Stretch]:
    """
    Return the stretches of a log; raise DdctError when none is long enough.

    A sample is a row with all three speeds. Each torque has its own rows. A gap of any of them
    ends a stretch. Where C_load was not measured `known_load` gives its known part, between the
    samples of w_r as the log's `held` says. Raise DdctError too where a signal is sampled more
    slowly or faster than that of a car is.
    """
    speeds = np.column_stack([log.signals[name] for name in SPEEDS])
    rows = np.isfinite(speeds).all(axis=1)
    if rows.sum() < FEWEST_SAMPLES:
        raise DdctError(
            f'{rows.sum()} rows have all of {", ".join(SPEEDS)}: give at least {FEWEST_SAMPLES}',
            place=log.path,
        )
    _require_sampling(log)
    time_s, speeds = log.time_s[rows], speeds[rows]
    torques = {name: log.samples(name) for name in (*TORQUES, LOAD) if name in log.signals}
    number_of = _stretch_numbers(time_s, [time_s, *(times for times, _ in torques.values())])
    within = number_of >= 0
    # The numbers rise along the log, so each stretch is one piece of it.
    parting = np.flatnonzero(np.diff(number_of[within])) + 1
    pieces = (np.split(each[within], parting) for each in (time_s, speeds))
    stretches = [
        _stretch(log, times, rows, known_load)
        for times, rows in zip(*pieces, strict=True)
        if len(times) >= FEWEST_SAMPLES
    ]
    if not stretches:
        raise DdctError(
            f'no {FEWEST_SAMPLES} samples in a row without a gap: give a log with fewer holes',
            place=log.path,
        )
    return stretches


def _require_sampling(log: MeasuredLog) -> None:
    """Raise DdctError where the sampling period of a signal is none of a log of a car."""
    lowest, highest = SAMPLING_S
    for name in (*SPEEDS, *TORQUES, LOAD):
        if name not in log.signals or len(log.samples(name)[0]) < 2:
            continue
        period = log.usual_step(name)
        if not lowest <= period <= highest:
            factor = 1e-3 if period > highest else 1e3
            raise DdctError(
                f'{name} has a sampling period of {period:.3g} s, and a fit needs {lowest:g} to '
                f'{highest:g} s: check the unit of columns.{TIME}, with which the period may be '
                f'{factor * period:.3g} s, or give another log',
                place=log.path,
                key=f'columns.{TIME}',
            )


def with_more_torque_noise(log: MeasuredLog, seed: int) -> MeasuredLog:
    """Return the log with the estimated variance of the white noise of its torques doubled."""
    random = np.random.default_rng(seed)
    signals = {
        name: log.signals[name]
        + white_noise(log.samples(name)[1]) * random.standard_normal(len(log.time_s))
        for name in TORQUES
    }
    return replace(log, signals={**log.signals, **signals})


def torques_are_noisy(log: MeasuredLog) -> bool:
    """Return whether a torque has white noise that affects a fit."""
    samples = [log.samples(name)[1] for name in TORQUES]
    return any(white_noise(each) > _NOISY * float(np.std(each)) for each in samples)


def white_noise(values: np.ndarray) -> float:
    """
    Return the standard deviation of white noise on a smooth signal, from its third differences.

    Their variance is 20 times that of the noise; the median is robust against steps and bends.
    """
    if len(values) < FEWEST_SAMPLES:
        return 0.0
    return float(np.median(np.abs(np.diff(values, 3))) / _MEDIAN / np.sqrt(20.0))


def _stretch_numbers(time_s: np.ndarray, sampled: list[np.ndarray]) -> np.ndarray:
    """Return the number of the stretch of each time, -1 within a gap of one of the signals."""
    part = np.zeros(len(time_s), dtype=int)
    known = np.ones(len(time_s), dtype=bool)
    for times in sampled:
        steps = np.diff(times)
        gaps = np.flatnonzero(steps > _GAP * np.median(steps))
        begun = np.searchsorted(times[gaps], time_s, side='left')
        ended = np.searchsorted(times[gaps + 1], time_s, side='right')
        known &= (time_s >= times[0]) & (time_s <= times[-1]) & (begun == ended)
        part += ended
    return np.where(known, part, -1)


def _stretch(
    log: MeasuredLog,
    time_s: np.ndarray,
    speeds: np.ndarray,
    known_load: KnownLoad,
) -> Stretch:
    """Return a stretch of a log, with the torques on a grid as fine as the finest signal."""
    usual = float(np.median(np.diff(time_s)))
    even = bool(np.all(np.abs(np.diff(time_s) - usual) <= _UNEVEN * usual))
    if even:
        usual = float(time_s[-1] - time_s[0]) / (len(time_s) - 1)
        time_s = time_s[0] + usual * np.arange(len(time_s))
    finer = [1.0 if even else _FOR_UNEVEN]
    finer += [usual / log.usual_step(name) for name in TORQUES]
    step = usual / min(max(round(max(finer)), 1), _FINEST)
    # The largest shift: a torque with the largest delay, of a speed with the largest lead.
    before = int(np.ceil(2.0 * MOST_DELAY_S / step))
    after = before + int(np.ceil((time_s[-1] - time_s[0]) / step - 1e-6))
    grid_s = time_s[0] + step * np.arange(-before, after + 1)
    known = LOAD in log.signals
    if known:
        load = log.at(LOAD, grid_s)
    else:
        wheel_speed = speeds[:, SPEED_COLUMNS['wheel_speed']]
        load = known_load(between(time_s, wheel_speed, grid_s, held=LOAD in log.held))
    second_differences = [_second_difference(log, name, grid_s) for name in TORQUES]
    return Stretch(
        time_s=time_s,
        speeds=speeds,
        grid_s=grid_s,
        torques=np.column_stack([*(log.at(name, grid_s) for name in TORQUES), load]),
        second_differences=np.column_stack([*second_differences, np.zeros(len(grid_s))]),
        held=tuple(name in log.held for name in (*TORQUES, LOAD)),
        load_known=known,
        known_s=(float(time_s[0]), float(time_s[-1])),
    )


def _second_difference(log: MeasuredLog, name: str, grid_s: np.ndarray) -> np.ndarray:
    """Return the second difference in N m of a torque over a step of its rows, 0 if it is held."""
    if name in log.held:
        return np.zeros(len(grid_s))
    step = log.usual_step(name)
    before, now, after = (log.at(name, grid_s + shift) for shift in (-step, 0.0, step))
    return before - 2.0 * now + after
