"""Whether the printed transfer functions and the identified driveline belong together."""

from dataclasses import dataclass

import numpy as np
import scipy

from ddct_plant.identification.coefficients import PrintedCoefficients
from ddct_plant.identification.fit import ROUNDING_VARIANCE, Identification, predict_left_out
from ddct_plant.identification.rounding_set import smallest_worst_residual
from ddct_plant.models.printed import ENGINE_TO_SLIP, LOAD_TO_SLIP, PrintedTransferFunction

_SIGMAS = 3.0
_CONFIDENCE = 0.99
ZERO_PAIR = ('P2', 'zero c')
"""The coefficient that Section 1.6.2 prints as 334.4."""


@dataclass(frozen=True)
class IdentificationCheck:
    """One statement about the fit, its figure and the range it must lie in."""

    name: str
    value: float
    lowest: float
    highest: float

    @property
    def passed(self) -> bool:
        """Whether the value is in its range."""
        return self.lowest <= self.value <= self.highest


def check_identification(
    identification: Identification, p2: PrintedTransferFunction
) -> tuple[IdentificationCheck, ...]:
    """Return the checks of a fit to `p2` and P_3; P_1 took no part in it."""
    coefficients = PrintedCoefficients(p2, LOAD_TO_SLIP)
    worst, _ = smallest_worst_residual(coefficients, identification.logarithms)
    return (
        _engine_gain(identification),
        IdentificationCheck(
            f'chi-square of {identification.degrees_of_freedom} degrees of freedom',
            identification.chi_square,
            0.0,
            float(scipy.stats.chi2.ppf(_CONFIDENCE, identification.degrees_of_freedom)),
        ),
        IdentificationCheck('least possible worst residual, half-units', worst, 0.0, 1.0),
        _zero_pair(coefficients, p2),
    )


def _engine_gain(identification: Identification) -> IdentificationCheck:
    printed = float(ENGINE_TO_SLIP.gain)
    gain = 1.0 / identification.parameters.engine_inertia
    margin = _SIGMAS * gain * float(identification.relative_std[0])
    return IdentificationCheck('gain of P1 = 1 / J_m', gain, printed - margin, printed + margin)


def _zero_pair(
    coefficients: PrintedCoefficients, p2: PrintedTransferFunction
) -> IdentificationCheck:
    printed = next(
        number for name, number in coefficients.numbers if (name, number.label) == ZERO_PAIR
    )
    predicted, std = predict_left_out(p2, LOAD_TO_SLIP, *ZERO_PAIR)
    margin = _SIGMAS * float(np.hypot(std, printed.half_unit * np.sqrt(ROUNDING_VARIANCE)))
    name = f'{" ".join(ZERO_PAIR)} from the other eight, printed {printed.text}'
    return IdentificationCheck(name, predicted, printed.value - margin, printed.value + margin)
