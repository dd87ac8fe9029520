# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Comfort of an engagement.

Jerk, weighted acceleration and vibration dose act on a passenger; judder, shuffle and torque dip
are oscillations of driveline and car.
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
from ddct_bringup.metrics.signals.integrals import integral, running_integral
from ddct_plant.base.timebase import PERIOD_S, STEPS_PER_S

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


def vibration_dose(weighted: np.ndarray) -> np.ndarray:
    """Return the vibration dose value, the fourth root of the integral of a^4, in m/s^1.75."""
    return integral(_fourth_power(weighted)) ** 0.25


def strongest_stretch(weighted: np.ndarray, periods: int) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the largest r.m.s. and the largest dose over all intervals of (..., n) `weighted`.

    An interval has `periods` periods; `weighted` has at least as many. The maximum over all
    intervals also includes late vibration.
    """
    before = np.zeros((*weighted.shape[:-1], 1))
    squares = np.cumsum(np.concatenate([before, weighted**2], axis=-1), axis=-1)
    fourths = running_integral(_fourth_power(weighted))
    means = (squares[..., periods + 1 :] - squares[..., : -periods - 1]) / (periods + 1)
    doses = fourths[..., periods:] - fourths[..., :-periods]
    return np.sqrt(np.max(means, axis=-1)), np.max(doses, axis=-1) ** 0.25


def _fourth_power(values: np.ndarray) -> np.ndarray:
    """Return a^4 by two multiplications; numpy's power of 4 takes many times as long."""
    return np.square(np.square(values))


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


def shuffle_of(torsion_speed: np.ndarray, start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """
    Return amplitude and decay time of the (..., n) w_sr from sample `start`, (...), on.

    The amplitude is the largest magnitude, in the unit of w_sr. The decay time in s is counted
    from that sample until the magnitude stays below 1/e of it; NaN when the samples end before.
    Both are NaN where no sample is left, or one is not finite.
    """
    samples = np.arange(torsion_speed.shape[-1])
    counted = samples >= start[..., np.newaxis]
    magnitude = np.where(counted, np.abs(torsion_speed), -1.0)
    peak, largest = np.argmax(magnitude, axis=-1), np.max(magnitude, axis=-1)
    above = magnitude >= largest[..., np.newaxis] / np.e
    after = len(samples) - np.argmax(above[..., ::-1], axis=-1)
    defined = counted[..., -1] & np.isfinite(magnitude).all(axis=-1)
    decay = np.where(defined & (after < len(samples)), (after - peak) / STEPS_PER_S, math.nan)
    return np.where(defined, largest, math.nan), decay


def torque_dip(torque: np.ndarray) -> np.ndarray | None:
    """Return the largest drop of the (..., n) torque below an earlier value, in its unit."""
    if not torque.size:
        return None
    return np.max(np.maximum.accumulate(torque, axis=-1) - torque, axis=-1)
