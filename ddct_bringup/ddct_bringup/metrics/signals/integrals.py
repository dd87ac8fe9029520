# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Integrals of samples by trapezoids.

numpy 1 and 2 have no name for it in common, and `scipy.integrate` takes a second to import.
"""

import numpy as np

from ddct_plant.base.timebase import PERIOD_S


def integral(values: np.ndarray, *, dx: float = PERIOD_S) -> np.ndarray:
    """Return the integral over time of (..., n) samples that are `dx` apart in s, (...)."""
    return np.sum(_pieces(values, dx), axis=-1)


def running_integral(values: np.ndarray) -> np.ndarray:
    """Return the integral of (..., n) samples of 100 Hz from the first one to each, (..., n)."""
    until = np.cumsum(_pieces(values, PERIOD_S), axis=-1)
    return np.concatenate([np.zeros_like(values[..., :1]), until], axis=-1)


def _pieces(values: np.ndarray, dx: float) -> np.ndarray:
    return dx * (values[..., 1:] + values[..., :-1]) / 2.0
