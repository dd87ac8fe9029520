# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Comfort of an engagement.

Jerk, weighted acceleration and vibration dose act on a passenger; judder, shuffle and torque dip
are oscillations of driveline and car.
"""

import math
from functools import cache

import numpy as np
import scipy

from ddct_plant.base.timebase import PERIOD_S, STEPS_PER_S

JERK_CUTOFF_HZ = 20.0
_JERK_FILTER_ORDER = 2
"""Order of the Butterworth filter, which runs forward and backward once each."""
JUDDER_BAND_HZ = (2.0, 20.0)
BAND_PASS_ORDER = 2
_PADDING = 3 * (2 * BAND_PASS_ORDER + 1)
"""Number of samples that `sosfiltfilt` adds at each end of an interval."""
SHORTEST_JUDDER_S = 1.0 / JUDDER_BAND_HZ[0]
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
    padding = 3 * (_JERK_FILTER_ORDER + 1)
    if acceleration.shape[-1] <= padding:
        return np.empty((*acceleration.shape[:-1], 0))
    return np.diff(scipy.signal.filtfilt(*_low_pass(), acceleration, padlen=padding)) / PERIOD_S


@cache
def _low_pass() -> tuple[np.ndarray, np.ndarray]:
    return scipy.signal.butter(_JERK_FILTER_ORDER, JERK_CUTOFF_HZ, fs=1.0 / PERIOD_S)


def weighted_acceleration(acceleration: np.ndarray) -> np.ndarray:
    """Return the (..., n) acceleration in m/s^2 weighted by W_d, initially in steady state."""
    sos = _weighting()
    return scipy.signal.sosfilt(sos, acceleration, zi=at_rest(sos, acceleration[..., :1]))[0]


def at_rest(sos: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the states (sections, ..., 2) of a filter in steady state at values (..., 1)."""
    states = scipy.signal.sosfilt_zi(sos)
    return states.reshape(len(sos), *(1,) * (values.ndim - 1), 2) * values


@cache
def _weighting() -> np.ndarray:
    """
    Return the weighting W_d as second-order sections for 100 Hz.

    ISO 2631-1 gives W_d as a second-order high-pass at 0.4 Hz with Q = 1/sqrt(2), and (1 + s/w3) /
    (1 + s/(Q4 w4) + (s/w4)^2) with w3 = w4 = 2 pi 2.0 rad/s and Q4 = 0.63.
    """
    high_pass = 2.0 * np.pi * 0.4
    corner, quality = 2.0 * np.pi * 2.0, 0.63
    sections = [
        ([1.0, 0.0, 0.0], [1.0, np.sqrt(2.0) * high_pass, high_pass**2]),
        ([1.0 / corner, 1.0], [1.0 / corner**2, 1.0 / (quality * corner), 1.0]),
    ]
    return np.vstack([np.hstack(_digital(*section)) for section in sections])


def vibration_dose(weighted: np.ndarray) -> np.ndarray:
    """Return the vibration dose value, the fourth root of the integral of a^4, in m/s^1.75."""
    return scipy.integrate.trapezoid(_fourth_power(weighted), dx=PERIOD_S) ** 0.25


def strongest_stretch(weighted: np.ndarray, periods: int) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the largest r.m.s. and the largest dose over all intervals of (..., n) `weighted`.

    An interval has `periods` periods; `weighted` has at least as many. The maximum over all
    intervals also includes late vibration.
    """
    before = np.zeros((*weighted.shape[:-1], 1))
    squares = np.cumsum(np.concatenate([before, weighted**2], axis=-1), axis=-1)
    fourths = scipy.integrate.cumulative_trapezoid(
        _fourth_power(weighted), dx=PERIOD_S, initial=0.0
    )
    means = (squares[..., periods + 1 :] - squares[..., : -periods - 1]) / (periods + 1)
    doses = fourths[..., periods:] - fourths[..., :-periods]
    return np.sqrt(np.max(means, axis=-1)), np.max(doses, axis=-1) ** 0.25


def _fourth_power(values: np.ndarray) -> np.ndarray:
    """Return a^4 by two multiplications; numpy's power of 4 takes many times as long."""
    return np.square(np.square(values))


def _digital(numerator: list[float], denominator: list[float]) -> tuple[np.ndarray, np.ndarray]:
    """Return the digital section of an analogue one; each polynomial has three coefficients."""
    b, a = scipy.signal.bilinear(numerator, denominator, fs=1.0 / PERIOD_S)
    return np.pad(b, (0, 3 - len(b))), np.pad(a, (0, 3 - len(a)))


@cache
def band_pass() -> np.ndarray:
    """Return the Butterworth band-pass of the judder as second-order sections."""
    return scipy.signal.butter(
        BAND_PASS_ORDER, JUDDER_BAND_HZ, 'bandpass', fs=STEPS_PER_S, output='sos'
    )


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
        filtered = _band_passed(rows[long], begins[long, np.newaxis], length[long, np.newaxis])
        # Each mean is that of its own samples alone, so it does not depend on other runs.
        means = [np.mean(row[:n] ** 2) for row, n in zip(filtered, length[long], strict=True)]
        found[long] = np.sqrt(means)
    return found.reshape(np.shape(first))


def _band_passed(values: np.ndarray, first: np.ndarray, length: np.ndarray) -> np.ndarray:
    """
    Return values[r, first[r]:first[r] + length[r]] after `sosfiltfilt` with the band-pass.

    `first` and `length` are (R, 1), each length above `_PADDING`. Each interval is shifted to the
    start of its row, so that one call filters all; samples after an interval do not count.
    """
    sos = band_pass()
    place = np.arange(values.shape[-1] + 2 * _PADDING)
    padded = _padded(values, first, length, place - _PADDING)
    forward = scipy.signal.sosfilt(sos, padded, zi=at_rest(sos, padded[:, :1]))[0]
    turned = np.maximum(length + 2 * _PADDING - 1 - place, 0)
    backward = np.take_along_axis(forward, turned, axis=-1)
    filtered = scipy.signal.sosfilt(sos, backward, zi=at_rest(sos, backward[:, :1]))[0]
    return np.take_along_axis(filtered, np.maximum(turned - _PADDING, 0), axis=-1)


def _padded(
    values: np.ndarray, first: np.ndarray, length: np.ndarray, sample: np.ndarray
) -> np.ndarray:
    """Return the intervals with point-symmetric extensions about their end values."""
    last = length - 1
    turned = np.where(sample > last, 2 * last - sample, np.abs(sample))
    mirrored = np.take_along_axis(values, first + np.clip(turned, 0, last), axis=-1)
    ends = np.take_along_axis(values, first + np.where(sample < 0, 0, last), axis=-1)
    beyond = (sample < 0) | (sample > last)
    return np.where(beyond, 2.0 * ends - mirrored, mirrored)


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
