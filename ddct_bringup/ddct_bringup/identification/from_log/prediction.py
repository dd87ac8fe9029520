# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Prediction of held-out data by a fitted driveline."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ddct_bringup.identification.from_log.delays import residuals_by_name, without_ends
from ddct_bringup.identification.from_log.noise import whiteness
from ddct_bringup.identification.from_log.result import SLIP, LogFit
from ddct_bringup.identification.from_log.stretch import Stretch, slip_of
from ddct_bringup.identification.from_log.stretches import white_noise
from ddct_bringup.logs.log import SPEEDS

WHITE_FROM = 0.01
"""Least p-value of residuals that count as white."""
NEGLIGIBLE = 2e-4
"""Largest negligible r.m.s. in a speed, over its standard deviation in the fitted data."""
_STILL = 1e-9
"""Standard deviation in rad/s assumed for a speed that does not change."""
_BEYOND_NOISE = 2.0
"""Least standard deviation of a speed that varies, over that of its white noise."""
_REPEATS = 0.25
"""Least share of equal neighbours in a signal whose resolution shows."""
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
    whiteness_p: float | None
    """p-value of Ljung and Box for the whitened residuals; None for the slip."""
    torque_p: float | None
    """p-value of the fit's residuals for noise independent of the torques; None for the slip."""

    @property
    def white(self) -> bool | None:
        """Whether both tests accept the residual as white noise; None where not tested."""
        if self.whiteness_p is None or self.torque_p is None:
            return None
        return min(self.whiteness_p, self.torque_p) >= WHITE_FROM


def predict(fit: LogFit, stretches: Sequence[Stretch]) -> list[SpeedPrediction]:
    """
    Return the prediction of w_m, w_p, w_r and of the slip w_m - w_p.

    The initial state of each stretch, and its C_load where it was not measured, are fitted to the
    held-out data; the driveline is not.
    """
    values = fit.values | fit.delays | fit.bends
    stretches = without_ends(stretches, values)
    left = [residuals_by_name(values, each)[0] for each in stretches]
    p_values = whiteness([fit.noise.white(each) for each in left])
    measured, residual = (
        np.column_stack([speeds, slip_of(speeds)])
        for speeds in (np.vstack([each.speeds for each in stretches]), np.vstack(left))
    )
    found = []
    for index, name in enumerate((*SPEEDS, SLIP)):
        rms, spread = (
            float(np.sqrt(np.mean(residual[:, index] ** 2))),
            float(measured[:, index].std()),
        )
        noise = white_noise(residual[:, index])
        still = _still(measured[:, index], fit.spreads[name])
        tested = name in SPEEDS
        found.append(
            SpeedPrediction(
                signal=name,
                rms_rad_s=rms,
                nrmse=None if still else rms / spread,
                no_nrmse=still,
                error=math.sqrt(max(rms**2 - noise**2, 0.0))
                / max(spread, fit.spreads[name], _STILL),
                whiteness_p=p_values[index] if tested else None,
                torque_p=fit.dependences[name].p_value if tested else None,
            )
        )
    return found


def _still(measured: np.ndarray, fitted_spread: float) -> str | None:
    """
    Return in which way a speed of the held-out data, (n,), does not vary; None if it does.

    `fitted_spread` is its standard deviation in rad/s in the fitted data.
    """
    spread = float(measured.std())
    if spread <= _SAME:
        return 'it is constant'
    least = {
        'its noise': _BEYOND_NOISE * white_noise(measured),
        'its resolution': _resolution(measured),
        f'{100.0 * NEGLIGIBLE:g} % of that in the fitted data': NEGLIGIBLE * fitted_spread,
    }
    for name, size in least.items():
        if spread <= size:
            return f'its deviation of {spread:.2g} rad/s is not beyond {name}'
    return None


def _resolution(measured: np.ndarray) -> float:
    """Return the least step of a signal with many equal neighbours, 0 where it has none."""
    steps = np.abs(np.diff(measured))
    equal = steps <= _SAME
    if not steps.size or equal.mean() < _REPEATS or equal.all():
        return 0.0
    return float(steps[~equal].min())
