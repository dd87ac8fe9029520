# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Prediction of held-out data by a fitted driveline."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ddct_bringup.identification.from_log.problem import used
from ddct_bringup.identification.from_log.response import residuals_of
from ddct_bringup.identification.from_log.result import SLIP, LogFit
from ddct_bringup.identification.from_log.stretches import Stretch, resolution, white_noise
from ddct_bringup.logs.log import SPEEDS

NEGLIGIBLE = 2e-4
"""Largest negligible deviation of a speed, over that in the fitted data."""
_STILL = 1e-9
"""Standard deviation in rad/s assumed for a speed that does not change."""
_BEYOND_NOISE = 2.0
"""Least standard deviation of a speed that varies, over that of its white noise."""
_SAME = 1e-9
"""Largest difference in rad/s of two equal values, by rounding."""


@dataclass(frozen=True)
class SpeedPrediction:
    """Quality of the prediction of one speed of the held-out data."""

    signal: str
    """Name of the speed."""
    rms_rad_s: float
    """R.m.s. of measured less predicted speed in rad/s."""
    nrmse: float | None
    """R.m.s. over the standard deviation of the measured speed; None where that does not vary."""
    no_nrmse: str | None
    """Reason for an NRMSE of None."""
    error: float
    """R.m.s. without white noise, over the larger standard deviation of held-out and fitted
    data."""


def predict(fit: LogFit, stretches: Sequence[Stretch]) -> list[SpeedPrediction]:
    """
    Return the prediction of w_m, w_p, w_r and of the slip w_m - w_p.

    The initial state of each stretch, and its C_load where it was not measured, are fitted to the
    held-out data; the driveline is not.
    """
    stretches = used(stretches, fit.all_values)
    left = np.vstack([residuals_of(fit.all_values, each)[0] for each in stretches])
    measured = np.vstack([each.speeds for each in stretches])
    columns = (np.column_stack([each, each[:, 0] - each[:, 1]]) for each in (measured, left))
    return [
        _prediction(name, values, residuals, fit.spreads[name])
        for name, values, residuals in zip(
            (*SPEEDS, SLIP), *(each.T for each in columns), strict=True
        )
    ]


def _prediction(
    name: str, measured: np.ndarray, residuals: np.ndarray, fitted_spread: float
) -> SpeedPrediction:
    """Return the prediction of a speed, (n,); `fitted_spread` is that of the fitted data."""
    rms, spread = float(np.sqrt(np.mean(residuals**2))), float(measured.std())
    error = math.sqrt(max(rms**2 - white_noise(residuals) ** 2, 0.0))
    still = _still(measured, fitted_spread)
    return SpeedPrediction(
        signal=name,
        rms_rad_s=rms,
        nrmse=None if still else rms / spread,
        no_nrmse=still,
        error=error / max(spread, fitted_spread, _STILL),
    )


def _still(measured: np.ndarray, fitted_spread: float) -> str | None:
    """Return in which way a speed of the held-out data, (n,), does not vary; None if it does."""
    spread = float(measured.std())
    if spread <= _SAME:
        return 'it is constant'
    least = {
        'its noise': _BEYOND_NOISE * white_noise(measured),
        'its resolution': resolution(measured),
        f'{100.0 * NEGLIGIBLE:g} % of that in the fitted data': NEGLIGIBLE * fitted_spread,
    }
    for name, size in least.items():
        if spread <= size:
            return f'its deviation of {spread:.2g} rad/s is not beyond {name}'
    return None
