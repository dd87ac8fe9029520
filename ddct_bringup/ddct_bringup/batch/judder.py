"""Judder of many runs at once, each over a stretch of its own."""

import numpy as np
import scipy

from ddct_bringup.verdict.comfort import at_rest
from ddct_bringup.verdict.vibration import BAND_PASS_ORDER, band_pass

_PADDING = 3 * (2 * BAND_PASS_ORDER + 1)
"""Samples that `sosfiltfilt` adds at both ends of a stretch."""


def judder_of(torsion_speed: np.ndarray, first: np.ndarray, after: np.ndarray) -> np.ndarray:
    """
    Return what `vibration.judder` returns of torsion_speed[r, first[r]:after[r]], (R,).

    `torsion_speed` is (R, N+1); a stretch has more than `_PADDING` samples. Each is moved to the
    start of its row, so that one call filters all; what stands behind a stretch does not count.
    """
    sos = band_pass()
    length = (after - first)[:, np.newaxis]
    place = np.arange(torsion_speed.shape[-1] + 2 * _PADDING)
    padded = _padded(torsion_speed, first[:, np.newaxis], length, place - _PADDING)
    forward = scipy.signal.sosfilt(sos, padded, zi=at_rest(sos, padded[:, :1]))[0]
    backward_place = np.maximum(length + 2 * _PADDING - 1 - place, 0)
    turned = np.take_along_axis(forward, backward_place, axis=-1)
    filtered = scipy.signal.sosfilt(sos, turned, zi=at_rest(sos, turned[:, :1]))[0]
    inside = (place >= _PADDING) & (place < _PADDING + length)
    return np.sqrt(np.sum(np.where(inside, filtered, 0.0) ** 2, axis=-1) / length[:, 0])


def _padded(
    values: np.ndarray, first: np.ndarray, length: np.ndarray, sample: np.ndarray
) -> np.ndarray:
    """Return samples of the stretches, beyond their ends turned about the value there."""
    last = length - 1
    turned = np.where(sample > last, 2 * last - sample, np.abs(sample))
    mirrored = np.take_along_axis(values, first + np.clip(turned, 0, last), axis=-1)
    ends = np.take_along_axis(values, first + np.where(sample < 0, 0, last), axis=-1)
    beyond = (sample < 0) | (sample > last)
    return np.where(beyond, 2.0 * ends - mirrored, mirrored)
