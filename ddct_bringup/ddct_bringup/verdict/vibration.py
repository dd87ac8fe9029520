"""Vibration of driveline and car during an engagement: judder, shuffle, dip, mean jerk."""

from functools import cache

import numpy as np
import scipy

from ddct_plant.base.timebase import PERIOD_S, STEPS_PER_S

JUDDER_BAND_HZ = (2.0, 20.0)
BAND_PASS_ORDER = 2
SHORTEST_JUDDER_S = 1.0
"""Of slipping: two periods of the lowest frequency of the band."""


@cache
def band_pass() -> np.ndarray:
    """Return the Butterworth band-pass, as sections."""
    return scipy.signal.butter(
        BAND_PASS_ORDER, JUDDER_BAND_HZ, 'bandpass', fs=STEPS_PER_S, output='sos'
    )


def judder(torsion_speed: np.ndarray) -> float | None:
    """
    Return the root of the mean square of the (n,) w_sr between 2 and 20 Hz, in its unit.

    The samples are those while the clutch slips. A second-order Butterworth band-pass runs forward
    and backward. None for less than 1 s.
    """
    if (len(torsion_speed) - 1) * PERIOD_S < SHORTEST_JUDDER_S:
        return None
    return float(np.sqrt(np.mean(scipy.signal.sosfiltfilt(band_pass(), torsion_speed) ** 2)))


def shuffle(torsion_speed: np.ndarray) -> tuple[float | None, float | None]:
    """
    Return amplitude and decay time of the (n,) w_sr after lock.

    The amplitude is the largest magnitude, in the unit of w_sr. The decay time in s runs from
    there until the magnitude stays below 1/e of it; None when the samples end before.
    """
    if not torsion_speed.size or not np.isfinite(torsion_speed).all():
        return None, None
    magnitude = np.abs(torsion_speed)
    peak = int(np.argmax(magnitude))
    last = int(np.flatnonzero(magnitude >= magnitude[peak] / np.e)[-1])
    decay = (last + 1 - peak) / STEPS_PER_S if last + 1 < len(magnitude) else None
    return float(magnitude[peak]), decay


def torque_dip(torque: np.ndarray) -> np.ndarray | None:
    """Return how far the (..., n) torque falls at most below an earlier value, in its unit."""
    if not torque.size:
        return None
    return np.max(np.maximum.accumulate(torque, axis=-1) - torque, axis=-1)


def mean_jerk(acceleration: np.ndarray) -> np.ndarray | None:
    """Return the largest magnitude of the jerk's mean over 1 s in m/s^3; None below 1 s."""
    changes = acceleration[..., STEPS_PER_S:] - acceleration[..., :-STEPS_PER_S]
    return np.max(np.abs(changes), axis=-1) if changes.size else None
