"""One number or word that the thesis prints, and what is claimed about it."""

import math
from dataclasses import dataclass

from ddct_bringup.thesis.table_5_1 import CALIBRATED, PREDICTED
from ddct_plant.base.errors import ParameterError, require_number
from ddct_plant.models.printed import PrintedNumber


@dataclass(frozen=True)
class Finding:
    """Whether a claim in words holds, and the figures that show it."""

    holds: bool
    figures: str


Value = float | str | Finding
"""What is computed for a printed number, or the word or finding for a printed word."""

REPRODUCED = 'reproduced'
ERRATUM = 'erratum'
COMPUTED_VERDICTS = (REPRODUCED, ERRATUM, CALIBRATED, PREDICTED)
VERDICTS = (*COMPUTED_VERDICTS, 'given', 'not_reproducible')
"""
What can be said of a printed number.

`reproduced`: the thesis's other numbers lead to it. `erratum`: they lead far off it.
`calibrated`: parameters of ours were fitted to its group. `predicted`: a model that was fitted to
other numbers, or a rule that the thesis does not state, leads to it or misses it. `given`: an
input of the thesis.
`not_reproducible`: a result of the thesis whose inputs it does not print.
"""


@dataclass(frozen=True)
class Tolerance:
    """How far a number may lie from the printed one: the widest of the parts that are given."""

    half_units: float = 0.0
    """In halves of a unit of the last printed digit; 1 is the rounding of the print."""
    significant: float = 0.0
    """Half a unit of this significant digit: rounding where the print drops trailing zeros."""
    relative: float = 0.0
    """As a fraction of the printed number."""
    absolute: float = 0.0
    """In the number's own unit."""

    def __post_init__(self) -> None:
        """Check the parts; raise ParameterError when none is given or one is negative."""
        parts = {name: getattr(self, name) for name in self.__dataclass_fields__}
        for name, part in parts.items():
            require_number(f'tolerance: {name}', part, at_least=0.0)
        if not any(parts.values()):
            raise ParameterError(f'tolerance: give {", ".join(parts)}, above 0')

    def around(self, printed: str) -> float:
        """Return the tolerance of a printed number in its own unit."""
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
    """With the digits that the thesis prints, or a word."""
    verdict: str
    """One of VERDICTS."""
    reason: str
    """Why this tolerance; of an erratum, what is wrong; of the rest, why nothing is computed."""
    unit: str = '1'
    id: str | None = None
    """Name under which a source computes it; None when nothing does."""
    tolerance: Tolerance | None = None
    """None for words, which must be equal, and for what is computed as a Finding."""
    group: str | None = None
    """What one computation, input or cause leads to together; counted as one fact."""
    ours: str | None = None
    """Our value of an erratum, to the digits that must come out; or a word."""
    hit: str | None = None
    """'no' of a calibrated number that the fit misses."""

    def __post_init__(self) -> None:
        """Check that the claim is complete; raise ParameterError that names what is not."""
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
        """Whether a number is printed, not a word."""
        return is_number(self.printed)

    @property
    def absolute_tolerance(self) -> float | None:
        """The tolerance in the number's unit, None without one."""
        return self.tolerance.around(self.printed) if self.tolerance else None

    @property
    def fact(self) -> str:
        """The group, or the number itself where it has none: what is counted once."""
        return self.group or f'{self.section}, {self.item}'


def is_number(text: str) -> bool:
    """Return whether the text is a number."""
    try:
        float(text)
    except ValueError:
        return False
    return True
