"""How well a fitted driveline predicts what it was not fitted to."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ddct_plant.identification.log_fit import LogFit
from ddct_plant.identification.log_model import Stretch, residuals_of
from ddct_plant.identification.log_noise import whiteness
from ddct_plant.identification.log_stretches import SPEEDS

WHITE_FROM = 0.01
"""Smallest p-value of residuals that count as white."""


@dataclass(frozen=True)
class Prediction:
    """One speed of the data that were held out, beside what the fitted driveline makes of it."""

    signal: str
    rms_rad_s: float
    """R.m.s. of measured less predicted."""
    nrmse: float | None
    """The same over the standard deviation of what was measured; None where it is constant."""
    whiteness_p: float | None
    """p of Ljung and Box for the residuals behind the fit's noise model; None for the slip."""

    @property
    def white(self) -> bool | None:
        """Whether nothing but noise is left, as far as the test shows; None where not tested."""
        return None if self.whiteness_p is None else self.whiteness_p >= WHITE_FROM


def predict(fit: LogFit, stretches: Sequence[Stretch]) -> list[Prediction]:
    """
    Return the prediction of w_m, w_p, w_r and of the slip w_m - w_p.

    The speeds at the start of each stretch, and its C_load where it was not measured, are fitted
    to it, the driveline is not.
    """
    left = [residuals_of(fit.values, each)[0] for each in stretches]
    p_values = whiteness([fit.noise.white(each) for each in left])
    measured, residual = np.vstack([each.speeds for each in stretches]), np.vstack(left)
    found = [
        _prediction(name, measured[:, index], residual[:, index], p_values[index])
        for index, name in enumerate(SPEEDS)
    ]
    slip, of_slip = (each[:, 0] - each[:, 1] for each in (measured, residual))
    return [*found, _prediction('slip_speed', slip, of_slip, None)]


def _prediction(
    signal: str, measured: np.ndarray, residual: np.ndarray, p_value: float | None
) -> Prediction:
    rms, spread = float(np.sqrt(np.mean(residual**2))), float(np.std(measured))
    return Prediction(signal, rms, rms / spread if spread else None, p_value)
