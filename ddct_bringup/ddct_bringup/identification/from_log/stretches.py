# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The log as a fit uses it: stretches without a gap, with the torques on one grid."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ddct_bringup.logs.columns import MOST_DELAY_S, TIME
from ddct_bringup.logs.log import SPEEDS, MeasuredLog, between
from ddct_plant.base.errors import DdctError
from ddct_plant.linear.names import Names

TORQUES = ('engine_torque', 'clutch_torque')
"""Names of C_m and C_f, which a log must have."""
LOAD = 'load_torque'
"""Name of C_load, which a log may have."""
INPUTS, OUTPUTS = Names((*TORQUES, LOAD)), Names(SPEEDS)
"""Names of the columns of torques and speeds."""
SAMPLING_S = (1e-4, 0.1)
"""Shortest and longest sampling period of a signal; of others the unit of the time is wrong."""
FEWEST_SAMPLES = 40
"""Fewest samples of a stretch: 0.4 s at 100 Hz, just over a period of the locked driveline."""
_GAP = 5.0
"""Shortest gap, in median steps of a signal."""
_IRREGULAR = 0.5
"""Deviation from the median step, over that step, of one that is irregular."""
_MOST_IRREGULAR = 0.2
"""Largest share of irregular steps of a signal that is sampled evenly."""
_SNAPPED = 0.02
"""Largest deviation of equal steps, over the median step: their times are taken as equal."""
_FOR_UNEVEN = 4
"""Grid steps in the median step of the speeds where their steps are not equal."""
_FINEST = 20
"""Most grid steps in one step of the speeds."""
_MEDIAN = 0.6745
"""Median of the magnitude of a standard normal number."""
_SAME = 1e-9
"""Largest difference of two equal values, over the largest value, by the rounding of numbers."""
_WHOLE = 0.02
"""Largest distance of a whole number of steps from whole."""
KnownLoad = Callable[[np.ndarray], np.ndarray]
"""Function from wheel speeds in rad/s to the known part of C_load in N m, (n,) each."""


@dataclass(frozen=True, eq=False)
class Stretch:
    """A part of a log without a gap: n samples of the speeds, and the torques on a finer grid."""

    time_s: np.ndarray
    """Times of the samples in s, (n,)."""
    speeds: np.ndarray
    """Speeds w_m, w_p, w_r in rad/s, (n, 3), by OUTPUTS."""
    grid_s: np.ndarray
    """Times of the grid in s, (m,), in equal steps from before the first sample to after the
    last."""
    torques: np.ndarray
    """C_m, C_f and the known part of C_load in N m on the grid, (m, 3), by INPUTS."""
    held: tuple[bool, ...]
    """Whether each torque is held until its next sample; the others are linear between samples."""
    load_known: bool
    """Whether C_load was measured; otherwise a constant is fitted to each stretch."""

    @property
    def slip(self) -> np.ndarray:
        """Slip w_m - w_p in rad/s, (n,)."""
        return self.speeds[:, 0] - self.speeds[:, 1]

    def rows(self, kept: np.ndarray) -> 'Stretch':
        """Return the stretch with some of its samples, (n,)."""
        return replace(self, time_s=self.time_s[kept], speeds=self.speeds[kept])


def stretches_of(log: MeasuredLog, known_load: KnownLoad) -> list[Stretch]:
    """
    Return the stretches of a log, whose sampling is checked first.

    A sample is a row with all three speeds. Each torque has its own rows. A gap of any of them
    ends a stretch. Where C_load was not measured `known_load` gives its known part, between the
    samples of w_r as the log's `held` says. Raise DdctError, in one line, for a signal that is
    sampled unevenly, more slowly or faster than one of a car is, and where no stretch is long
    enough.
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
    torques = [log.samples(name)[0] for name in INPUTS if name in log.signals]
    number_of = _stretch_numbers(time_s, [time_s, *torques])
    within = number_of >= 0
    # The numbers rise along the log, so each stretch is one piece of it.
    parting = np.flatnonzero(np.diff(number_of[within])) + 1
    pieces = (np.split(each[within], parting) for each in (time_s, speeds))
    stretches = [
        _stretch(log, times, piece, known_load)
        for times, piece in zip(*pieces, strict=True)
        if len(times) >= FEWEST_SAMPLES
    ]
    if not stretches:
        raise DdctError(
            f'no {FEWEST_SAMPLES} samples in a row without a gap: give a log with fewer holes',
            place=log.path,
        )
    return stretches


def _require_sampling(log: MeasuredLog) -> None:
    """Raise DdctError where a signal is not sampled as one of a log of a car."""
    lowest, highest = SAMPLING_S
    for name in (*SPEEDS, *INPUTS):
        if name not in log.signals or len(log.samples(name)[0]) < 2:
            continue
        period, steps = log.usual_step(name), np.diff(log.samples(name)[0])
        if not lowest <= period <= highest:
            factor = 1e-3 if period > highest else 1e3
            raise DdctError(
                f'{name} has a sampling period of {period:.3g} s, and a fit needs {lowest:g} to '
                f'{highest:g} s: check the unit of columns.{TIME}, with which the period may be '
                f'{factor * period:.3g} s, or give another log',
                place=log.path,
                key=f'columns.{TIME}',
            )
        if np.mean(np.abs(steps - period) > _IRREGULAR * period) > _MOST_IRREGULAR:
            short, long = np.quantile(steps, (0.1, 0.9))
            raise DdctError(
                f'{name} is sampled unevenly, a tenth of its steps below {short:.3g} s and a '
                f'tenth above {long:.3g} s: give a log with equal steps',
                place=log.path,
                key=f'columns.{TIME}',
            )


def _stretch_numbers(time_s: np.ndarray, sampled: Sequence[np.ndarray]) -> np.ndarray:
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
    log: MeasuredLog, time_s: np.ndarray, speeds: np.ndarray, known_load: KnownLoad
) -> Stretch:
    """Return a stretch of a log, with the torques on a grid as fine as the finest signal."""
    usual = float(np.median(np.diff(time_s)))
    even = bool(np.all(np.abs(np.diff(time_s) - usual) <= _SNAPPED * usual))
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
        wheels = speeds[:, OUTPUTS['wheel_speed']]
        load = known_load(between(time_s, wheels, grid_s, held=LOAD in log.held))
    return Stretch(
        time_s=time_s,
        speeds=speeds,
        grid_s=grid_s,
        torques=np.column_stack([*(log.at(name, grid_s) for name in TORQUES), load]),
        held=tuple(name in log.held for name in INPUTS),
        load_known=known,
    )


def white_noise(values: np.ndarray) -> float:
    """
    Return the standard deviation of white noise on a smooth signal, from its third differences.

    Their variance is 20 times that of the noise; the median is robust against steps and corners.
    """
    if len(values) < FEWEST_SAMPLES:
        return 0.0
    return float(np.median(np.abs(np.diff(values, 3))) / _MEDIAN / np.sqrt(20.0))


def resolution(values: np.ndarray) -> float:
    """Return the step of a signal whose values are whole steps apart, 0 of any other."""
    changes = np.abs(np.diff(np.unique(values)))
    changes = changes[changes > _SAME * np.abs(values).max(initial=0.0)]
    if not changes.size:
        return 0.0
    steps = changes / changes.min()
    return float(changes.min()) if np.all(np.abs(steps - np.round(steps)) < _WHOLE) else 0.0
