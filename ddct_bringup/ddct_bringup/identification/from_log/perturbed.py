# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Logs with more of the errors of the torques, by which a fit measures what they do to it."""

from dataclasses import replace

import numpy as np

from ddct_bringup.identification.from_log.stretches import TORQUES, white_noise
from ddct_bringup.logs.log import SPEEDS, MeasuredLog

_NOISY = 1e-3
"""White noise of a torque over its standard deviation, below which a fit is not affected."""
_SEEDS = range(8)
"""Seeds of the logs with more noise."""
_DENSE = 0.5
"""Step of a torque's rows over that of the speeds, up to which linear interpolation is exact."""


def with_more_noise(log: MeasuredLog) -> list[MeasuredLog]:
    """Return logs with twice the variance of the white noise of the torques; none without it."""
    noise = {name: white_noise(log.samples(name)[1]) for name in TORQUES}
    if all(noise[name] <= _NOISY * float(np.std(log.samples(name)[1])) for name in TORQUES):
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
