# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Comfort of an engagement.

Jerk and weighted acceleration act on a passenger; judder is an oscillation of the driveline.
"""

import math

import numpy as np

from ddct_bringup.metrics.signals.filters import (
    BAND_HZ,
    BAND_PASS,
    LOW_PASS,
    WEIGHTING,
    filtered,
    forward_and_backward,
    forward_and_backward_within,
)
from ddct_plant.base.timebase import PERIOD_S

_LOW_PASS_PADDING = 9
"""Number of samples that the jerk's filter adds at each end, that of `scipy.signal.filtfilt`."""
_BAND_PASS_PADDING = 15
"""Number of samples that the judder's filter adds, that of `scipy.signal.sosfiltfilt`."""
SHORTEST_JUDDER_S = 1.0 / BAND_HZ[0]
"""
Shortest slipping time in s for which a judder is computed: 51 samples.

It is one period of the lowest frequency of the band. The filter itself needs 16 samples for its
padding.
"""


def jerk(acceleration: np.ndarray) -> np.ndarray:
    """
    Return the (..., n-1) jerk in m/s^3 midway between the (..., n) samples in m/s^2.

    The acceleration passes a second-order Butterworth low-pass of 20 Hz forward and backward,
    which adds no delay, and is differenced. It is extended by 90 ms beyond both ends,
    point-symmetric about its end values: a slope continues, and a constant gives no jerk. Fewer
    than 10 samples give an empty array.
    """
    if acceleration.shape[-1] <= _LOW_PASS_PADDING:
        return np.empty((*acceleration.shape[:-1], 0))
    return np.diff(forward_and_backward(LOW_PASS, acceleration, _LOW_PASS_PADDING)) / PERIOD_S


def weighted_acceleration(acceleration: np.ndarray) -> np.ndarray:
    """Return the (..., n) acceleration in m/s^2 weighted by W_d, initially in steady state."""
    return filtered(WEIGHTING, acceleration)


def strongest_stretch(weighted: np.ndarray, samples: int) -> np.ndarray:
    """Return the largest r.m.s. of `samples` of (..., n) values in sequence, (...)."""
    before = np.zeros((*weighted.shape[:-1], 1))
    squares = np.cumsum(np.concatenate([before, weighted**2], axis=-1), axis=-1)
    return np.sqrt(np.max(squares[..., samples:] - squares[..., :-samples], axis=-1) / samples)


def judder_of(torsion_speed: np.ndarray, first: np.ndarray, after: np.ndarray) -> np.ndarray:
    """
    Return the r.m.s. between 2 and 20 Hz of the (..., n) w_sr from `first` to before `after`.

    The samples are those while the clutch slips, (...) each; the result has the unit of w_sr. A
    second-order Butterworth band-pass runs forward and backward. NaN for less than
    `SHORTEST_JUDDER_S`.
    """
    rows = torsion_speed.reshape(-1, torsion_speed.shape[-1])
    begins, length = np.ravel(first), np.ravel(after - first)
    long = (length - 1) * PERIOD_S >= SHORTEST_JUDDER_S
    found = np.full(len(rows), math.nan)
    if long.any():
        passed = forward_and_backward_within(
            BAND_PASS,
            rows[long],
            begins[long, np.newaxis],
            length[long, np.newaxis],
            _BAND_PASS_PADDING,
        )
        # Each mean is that of its own samples alone, so it does not depend on other runs.
        means = [np.mean(row[:n] ** 2) for row, n in zip(passed, length[long], strict=True)]
        found[long] = np.sqrt(means)
    return found.reshape(np.shape(first))
