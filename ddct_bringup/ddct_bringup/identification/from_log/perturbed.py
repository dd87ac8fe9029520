# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Logs with more of the errors of the torques, by which a fit measures what they do to it."""

from dataclasses import replace
from itertools import product

import numpy as np

from ddct_bringup.identification.from_log.stretches import TORQUES, resolution, white_noise
from ddct_bringup.logs.log import SPEEDS, MeasuredLog

_NEGLIGIBLE = 1e-3
"""Noise or rounding of a torque over its standard deviation, below which no fit is affected."""
_SEEDS = range(8)
"""Seeds of the logs with more noise."""
_DENSE = 0.5
"""Step of a torque's rows over that of the speeds, up to which linear interpolation is exact."""


def with_more_noise(log: MeasuredLog) -> list[MeasuredLog]:
    """
    Return logs with twice the variance of the white noise of the torques; none without it.

    A torque that is rounded to more than its noise stays.
    """
    noise = {
        name: 0.0 if _rounding(log, name) else white_noise(log.samples(name)[1])
        for name in TORQUES
    }
    if all(noise[name] <= _least(log, name) for name in TORQUES):
        return []
    return [
        _changed(
            log,
            {
                name: log.signals[name] + size * random.standard_normal(len(log.time_s))
                for name, size in noise.items()
            },
        )
        for random in map(np.random.default_rng, _SEEDS)
    ]


def rounded_again(log: MeasuredLog) -> list[MeasuredLog]:
    """
    Return logs whose torques are rounded to twice their step; none without rounded torques.

    A torque that moves slowly stays on one step for many rows, so the error of its rounding is no
    white noise. There are two ways to take the steps in pairs, for each torque.
    """
    steps = {name: step for name in TORQUES if (step := _rounding(log, name))}
    return [
        _changed(
            log,
            {
                name: _in_pairs(log.signals[name], step, pair)
                for (name, step), pair in zip(steps.items(), pairs, strict=True)
            },
        )
        for pairs in (product(range(2), repeat=len(steps)) if steps else ())
    ]


def _rounding(log: MeasuredLog, name: str) -> float:
    """Return the step to which a torque is rounded, 0 where that is small or within its noise."""
    values = log.samples(name)[1]
    step = resolution(values)
    small = step / np.sqrt(12.0) <= _least(log, name)
    return 0.0 if small or white_noise(values) > 0.5 * step else step


def _in_pairs(values: np.ndarray, step: float, pair: int) -> np.ndarray:
    """Return values with the mean of two neighbouring steps in place of both."""
    shift = (pair + 0.5) * step
    return 2.0 * step * np.round((values + shift) / (2.0 * step)) - shift


def _least(log: MeasuredLog, name: str) -> float:
    return _NEGLIGIBLE * float(np.std(log.samples(name)[1]))


def half_of_the_rows(log: MeasuredLog) -> list[MeasuredLog]:
    """
    Return the logs with every other row of the torques, of which there are two.

    A torque that is held, or sampled much faster than the speeds, is known between its rows.
    """
    names = [n for n in TORQUES if n not in log.held and not _is_dense(log, n)]
    return [
        _changed(log, {name: _thinned(log.signals[name], phase) for name in names})
        for phase in (range(2) if names else ())
    ]


def _is_dense(log: MeasuredLog, name: str) -> bool:
    return log.usual_step(name) < _DENSE * min(log.usual_step(each) for each in SPEEDS)


def _thinned(values: np.ndarray, phase: int) -> np.ndarray:
    rows = np.flatnonzero(np.isfinite(values))
    thinned = values.copy()
    thinned[rows[phase::2]] = np.nan
    return thinned


def _changed(log: MeasuredLog, signals: dict[str, np.ndarray]) -> MeasuredLog:
    return replace(log, signals={**log.signals, **signals})
