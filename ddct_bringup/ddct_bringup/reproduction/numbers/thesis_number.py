# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""One number or qualitative statement that the thesis prints, and the claim about it."""

import math
from dataclasses import dataclass

from ddct_bringup.thesis.table_5_1 import CALIBRATED, PREDICTED
from ddct_plant.base.errors import ParameterError, require_number
from ddct_plant.models.printed import PrintedNumber


@dataclass(frozen=True)
class Finding:
    """Result of a check of a qualitative claim, with the values behind it."""

    holds: bool
    evidence: str


Value = float | str | Finding
"""Computed value: a number for a printed number, a text or finding for a printed statement."""

REPRODUCED = 'reproduced'
ERRATUM = 'erratum'
COMPUTED_VERDICTS = (REPRODUCED, ERRATUM, CALIBRATED, PREDICTED)
VERDICTS = (*COMPUTED_VERDICTS, 'given', 'not_reproducible')
"""
Verdicts of a claim about a printed number.

`reproduced`: it follows from the thesis's other numbers. `erratum`: they give a different number.
`calibrated`: parameters of the model were fitted to its group. `predicted`: a model fitted to
other numbers, or a rule that the thesis does not state, reproduces or misses it. `given`: an
input of the thesis.
`not_reproducible`: a result of the thesis whose inputs it does not print.
"""


@dataclass(frozen=True)
class Tolerance:
    """Tolerance of a printed number: the largest of the parts that are given."""

    half_units: float = 0.0
    """Tolerance in halves of a unit of the last printed digit; 1 is the rounding of the print."""
    significant: float = 0.0
    """
    Significant digit whose half unit is the tolerance: rounding where the print drops trailing
    zeros.
    """
    relative: float = 0.0
    """Tolerance as a fraction of the printed number."""
    absolute: float = 0.0
    """Tolerance in the number's unit."""

    def __post_init__(self) -> None:
        """Check the parts; raise ParameterError when none is given or one is negative."""
        parts = {name: getattr(self, name) for name in self.__dataclass_fields__}
        for name, part in parts.items():
            require_number(f'tolerance: {name}', part, at_least=0.0)
        if not any(parts.values()):
            raise ParameterError(f'tolerance: give {", ".join(parts)}, above 0')

    def around(self, printed: str) -> float:
        """Return the tolerance of a printed number in the number's unit."""
        number = PrintedNumber('', printed)
        widest = max(
            self.half_units * number.half_unit, self.relative * abs(number.value), self.absolute
        )
        if not self.significant or not number.value:
            return widest
        exponent = math.floor(math.log10(abs(number.value))) + 1 - self.significant
        return max(widest, 0.5 * 10.0**exponent)


@dataclass(frozen=True)
class ThesisNumber:
    """One entry of the gate's file."""

    section: str
    item: str
    printed: str
    """Number with the digits that the thesis prints, or a text."""
    verdict: str
    """Verdict of the claim: one of VERDICTS."""
    reason: str
    """Reason for the tolerance; for an erratum, the error; for others, why nothing is computed."""
    unit: str = '1'
    id: str | None = None
    """Name under which a source computes the number; None when none does."""
    tolerance: Tolerance | None = None
    """Tolerance; None for text, which must be equal, and for a Finding."""
    group: str | None = None
    """Name of the numbers that one computation, input or cause determines; one fact together."""
    ours: str | None = None
    """Computed value of an erratum with its required digits; or a text."""
    hit: str | None = None
    """Value 'no' for a calibrated number that the fit misses."""

    def __post_init__(self) -> None:
        """Check that the claim is complete; raise ParameterError with the missing part."""
        computed = self.verdict in COMPUTED_VERDICTS
        complaints = {
            f'unknown verdict {self.verdict!r}: choose from {", ".join(VERDICTS)}': (
                self.verdict not in VERDICTS
            ),
            'give a reason': not self.reason.strip(),
            f'verdict {self.verdict} {"needs" if computed else "has no"} id': (
                computed != (self.id is not None)
            ),
            'a word, and what nothing computes, has no tolerance': (
                self.tolerance is not None and not (computed and self.is_number)
            ),
            'give `ours` with an erratum, not otherwise': (
                (self.verdict == ERRATUM) != (self.ours is not None)
            ),
            "`hit: 'no'` is for a calibrated number that the fit misses": (
                self.hit is not None and (self.hit, self.verdict) != ('no', CALIBRATED)
            ),
        }
        for complaint, applies in complaints.items():
            if applies:
                raise ParameterError(f'{self.section}, {self.item}: {complaint}')

    @property
    def is_number(self) -> bool:
        """Whether the printed value is a number, not a text."""
        return is_number(self.printed)

    @property
    def absolute_tolerance(self) -> float | None:
        """Tolerance in the number's unit, None without one."""
        return self.tolerance.around(self.printed) if self.tolerance else None

    @property
    def fact(self) -> str:
        """Group, or the number itself where it has none; facts are counted once."""
        return self.group or f'{self.section}, {self.item}'


def is_number(text: str) -> bool:
    """Return whether the text is a number."""
    try:
        float(text)
    except ValueError:
        return False
    return True
