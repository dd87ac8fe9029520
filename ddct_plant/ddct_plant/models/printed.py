# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The transfer functions that the thesis prints, digit by digit, with the errata corrected."""

from dataclasses import dataclass, replace
from decimal import Decimal

from ddct_plant.linear.lti import FactoredTransferFunction

PrintedFactor = str | tuple[str, str]
"""Printed factor: 'a' stands for (s + a), ('b', 'c') for (s^2 + b s + c), '0' for s."""


@dataclass(frozen=True)
class PrintedNumber:
    """A number with its printed digits."""

    label: str
    """Label of the coefficient: gain, or a, b, c of a zero or pole factor."""
    text: str
    """Coefficient as printed, for example '7696' or '3.134e04'."""

    @property
    def value(self) -> float:
        """Value of the number."""
        return float(self.text)

    @property
    def half_unit(self) -> float:
        """Half a unit of the last printed digit: the largest rounding error of the number."""
        return float(Decimal(5).scaleb(int(Decimal(self.text).as_tuple().exponent) - 1))


@dataclass(frozen=True)
class PrintedTransferFunction:
    """A factored transfer function whose numbers are the strings the thesis prints."""

    name: str
    gain: str
    numerator: tuple[PrintedFactor, ...]
    denominator: tuple[PrintedFactor, ...]

    def factored(self) -> FactoredTransferFunction:
        """Return the transfer function with the printed, rounded numbers."""
        return FactoredTransferFunction(
            float(self.gain),
            tuple(_number(factor) for factor in self.numerator),
            tuple(_number(factor) for factor in self.denominator),
        )

    def numbers(self) -> tuple[PrintedNumber, ...]:
        """Return the gain and every coefficient in the order of printing, exact '0's left out."""
        found = [PrintedNumber('gain', self.gain)]
        for kind, factors in (('zero', self.numerator), ('pole', self.denominator)):
            for factor in factors:
                names, texts = ('bc', factor) if isinstance(factor, tuple) else ('a', (factor,))
                found += [
                    PrintedNumber(f'{kind} {name}', text)
                    for name, text in zip(names, texts, strict=True)
                    if text != '0'
                ]
        return tuple(found)


def _number(factor: PrintedFactor) -> float | tuple[float, float]:
    return float(factor) if isinstance(factor, str) else (float(factor[0]), float(factor[1]))


ENGINE_TO_SLIP = PrintedTransferFunction('P1', '4', (), ('0',))
"""P_1 = w_d / C_m, Section 1.6.2."""

CLUTCH_TO_SLIP = PrintedTransferFunction(
    'P2',
    '-103.43',
    ('0.005905', ('5.344', '339.4')),
    ('0', '0.006733', ('121.4', '7696')),
)
"""
P_2 = w_d / C_f, Section 1.6.2, with 339.4 for the 334.4 that is printed there.

Every H-infinity controller of Section 3.3 has s^2 + 5.344 s + 339.4 as the poles that cancel these
zeros, and no driveline fits the other coefficients together with 334.4 (see `identification`).
"""

CLUTCH_TO_SLIP_AS_PRINTED = replace(CLUTCH_TO_SLIP, numerator=('0.005905', ('5.344', '334.4')))
"""P_2 with the erratum, as a counter-example that no driveline fits."""

LOAD_TO_SLIP = PrintedTransferFunction('P3', '7.2217', ('63.99',), ('0.006733', ('121.4', '7696')))
"""P_3 = w_d / C_load, Section 1.6.2; its poles are those of P_2."""

ACTUATOR = PrintedTransferFunction(
    'G_a',
    '25.305',
    ('138', ('-161.3', '3.134e04')),
    (('82.23', '2563'), ('134.1', '4.27e04')),
).factored()
"""G_a, the actuator's dynamics, Section 1.4.2; unit gain at rest, non-minimum phase."""
