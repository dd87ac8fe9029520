# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Means of acceleration over 2 s and of jerk over 1 s; ISO 15622 limits such means."""

import numpy as np

from ddct_bringup.metrics.signals.integrals import running_integral
from ddct_plant.base.timebase import STEPS_PER_S

MEAN_S = 2.0
"""Averaging time of the acceleration in s."""


def mean_acceleration(acceleration: np.ndarray) -> np.ndarray | None:
    """Return the largest mean over 2 s of (..., n) samples in m/s^2; None for less than 2 s."""
    samples = round(MEAN_S * STEPS_PER_S)
    if acceleration.shape[-1] <= samples:
        return None
    speed = running_integral(acceleration)
    gains = speed[..., samples:] - speed[..., :-samples]
    return np.max(gains, axis=-1) / MEAN_S


def mean_jerk(acceleration: np.ndarray) -> np.ndarray | None:
    """Return the largest magnitude of the mean jerk over 1 s in m/s^3; None below 1 s."""
    means = jerk_means(acceleration)
    return np.max(np.abs(means), axis=-1) if means.size else None


def mean_negative_jerk(acceleration: np.ndarray) -> np.ndarray | None:
    """
    Return the most negative mean over 1 s of the jerk in m/s^3, 0 where none is negative.

    None for (..., n) samples in m/s^2 of less than 1 s.
    """
    means = jerk_means(acceleration)
    return np.minimum(np.min(means, axis=-1), 0.0) if means.size else None


def jerk_means(acceleration: np.ndarray) -> np.ndarray:
    """Return the means of the jerk over 1 s in m/s^3; empty for less than 1 s."""
    return acceleration[..., STEPS_PER_S:] - acceleration[..., :-STEPS_PER_S]
