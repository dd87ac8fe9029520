# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Digital filters of the metrics, for 100 Hz, and their recursion.

`scipy.signal` takes a second to import, a third of the time of a program that scores one run. So
the first signals pass a recursion over the samples in numpy, and `scipy.signal.lfilter`, which is
quicker once it is there, filters what comes after. Both give the same bits.
"""

import numpy as np
import scipy

BAND_HZ = (2.0, 20.0)

LOW_PASS = np.array(
    [
        [
            *(0.20657208382614792, 0.41314416765229584, 0.20657208382614792),
            *(-0.3695273773512414, 0.19581571265583306),
            *(0.793427916173852, 0.01075637117031485),
        ]
    ]
)
"""
Butterworth low-pass of second order at 20 Hz.

A filter is an (n, 7) array of second-order sections (b0, b1, b2, a1, a2, z0, z1), the first one
applied first: the coefficients of (b0 + b1/z + b2/z^2) / (1 + a1/z + a2/z^2), and the states of
the transposed direct form II in equilibrium at a constant input of 1.
"""
BAND_PASS = np.array(
    [
        [
            *(0.17508764367210083, 0.35017528734420167, 0.17508764367210083),
            *(-0.47338545635197216, 0.2607010831459818),
            *(0.7144546832600693, -0.05681700446331295),
        ],
        [
            *(1.0, -2.0, 1.0),
            *(-1.8256698996865246, 0.8425510982273042),
            *(-0.9999999999999974, 0.9999999999999979),
        ],
    ]
)
"""Butterworth band-pass of second order from 2 to 20 Hz."""
WEIGHTING = np.array(
    [
        [
            *(0.9823863574202832, -1.9647727148405665, 0.9823863574202832),
            *(-1.96446245036963, 0.9650829793115029),
            *(-0.9823863574203231, 0.9823863574203217),
        ],
        [
            *(0.06050634046359328, 0.007153954753864039, -0.053352385709729236),
            *(-1.8049639537092204, 0.8192718632169483),
            *(0.9394936595364193, -0.8726242489266879),
        ],
    ]
)
"""
Weighting W_d by the bilinear transformation of the analogue filter.

ISO 2631-1 gives W_d as a second-order high-pass at 0.4 Hz with Q = 1/sqrt(2), and (1 + s/w3) /
(1 + s/(Q4 w4) + (s/w4)^2) with w3 = w4 = 2 pi 2.0 rad/s and Q4 = 0.63.
"""


def filtered(sections: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return (..., n) values after a filter that starts in equilibrium with the first of them."""
    for section in sections:
        values = _recursion(section, values)
    return values


class Recursion:
    """Recursion of a section; the number of samples in sequence so far chooses its means."""

    STEPS_BEFORE_IMPORT = 100_000
    """Number of samples in sequence that take as long as the import of `scipy.signal`."""

    def __init__(self) -> None:
        self._steps = 0

    def __call__(self, section: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Return (..., n) values after a section."""
        self._steps += values.shape[-1]
        apply = by_steps if self._steps < self.STEPS_BEFORE_IMPORT else by_scipy
        return apply(section, values)


_recursion = Recursion()


def by_steps(section: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return (..., n) values after a section; the operations are in the order of `lfilter`."""
    numerator, denominator, at_one = np.split(section[:, np.newaxis], [3, 5])
    inputs = values.reshape(-1, values.shape[-1]).T
    outputs = numerator[0] * inputs
    pending = numerator[1:] * inputs[:, np.newaxis]
    states = at_one * inputs[0]
    for output, coming in zip(outputs, pending, strict=True):
        output += states[0]
        coming[0] += states[1]
        coming -= denominator * output
        states = coming
    return np.ascontiguousarray(outputs.T).reshape(values.shape)


def by_scipy(section: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return (..., n) values after a section."""
    numerator, denominator, at_one = np.split(section, [3, 5])
    states = at_one * values[..., :1]
    return scipy.signal.lfilter(numerator, [1.0, *denominator], values, zi=states)[0]


def forward_and_backward(sections: np.ndarray, values: np.ndarray, padding: int) -> np.ndarray:
    """
    Return (..., n) values after a filter forward and backward, which adds no delay.

    They are extended by `padding` samples at both ends, fewer than n, point-symmetric about the
    end values.
    """
    before = 2.0 * values[..., :1] - values[..., padding:0:-1]
    after = 2.0 * values[..., -1:] - values[..., -2 : -padding - 2 : -1]
    padded = np.concatenate([before, values, after], axis=-1)
    backward = filtered(sections, filtered(sections, padded)[..., ::-1])
    return backward[..., ::-1][..., padding:-padding]


def forward_and_backward_within(
    sections: np.ndarray, values: np.ndarray, first: np.ndarray, length: np.ndarray, padding: int
) -> np.ndarray:
    """
    Return values[r, first[r]:first[r] + length[r]] as `forward_and_backward` does.

    `first` and `length` are (R, 1). Each interval is shifted to the start of its row, so that one
    call filters all of the (R, n) values; samples after an interval do not count.
    """
    place = np.arange(values.shape[-1] + 2 * padding)
    forward = filtered(sections, _padded(values, first, length, place - padding))
    turned = np.maximum(length + 2 * padding - 1 - place, 0)
    backward = filtered(sections, np.take_along_axis(forward, turned, axis=-1))
    kept = np.maximum(turned[:, : values.shape[-1]] - padding, 0)
    return np.take_along_axis(backward, kept, axis=-1)


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
