# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Comfort of an engagement.

Jerk, weighted acceleration and vibration dose act on a passenger; judder, shuffle and torque dip
are oscillations of driveline and car.
"""

from functools import cache

import numpy as np
import scipy

from ddct_plant.base.timebase import PERIOD_S, STEPS_PER_S

JERK_CUTOFF_HZ = 20.0
_JERK_FILTER_ORDER = 2
"""Order of the Butterworth filter, which runs forward and backward once each."""
JUDDER_BAND_HZ = (2.0, 20.0)
BAND_PASS_ORDER = 2
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


def judder(torsion_speed: np.ndarray) -> float | None:
    """
    Return the r.m.s. of the (n,) w_sr between 2 and 20 Hz, in the unit of w_sr.

    The samples are those while the clutch slips. A second-order Butterworth band-pass runs forward
    and backward. None for less than `SHORTEST_JUDDER_S`.
    """
    if (len(torsion_speed) - 1) * PERIOD_S < SHORTEST_JUDDER_S:
        return None
    return float(np.sqrt(np.mean(scipy.signal.sosfiltfilt(band_pass(), torsion_speed) ** 2)))


def shuffle(torsion_speed: np.ndarray) -> tuple[float | None, float | None]:
    """
    Return amplitude and decay time of the (n,) w_sr after lock.

    The amplitude is the largest magnitude, in the unit of w_sr. The decay time in s is counted
    from that sample until the magnitude stays below 1/e of it; None when the samples end before.
    """
    if not torsion_speed.size or not np.isfinite(torsion_speed).all():
        return None, None
    magnitude = np.abs(torsion_speed)
    peak = int(np.argmax(magnitude))
    last = int(np.flatnonzero(magnitude >= magnitude[peak] / np.e)[-1])
    decay = (last + 1 - peak) / STEPS_PER_S if last + 1 < len(magnitude) else None
    return float(magnitude[peak]), decay


def torque_dip(torque: np.ndarray) -> np.ndarray | None:
    """Return the largest drop of the (..., n) torque below an earlier value, in its unit."""
    if not torque.size:
        return None
    return np.max(np.maximum.accumulate(torque, axis=-1) - torque, axis=-1)
