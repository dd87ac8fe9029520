"""One number or word that the thesis prints, and what is claimed about it."""

from dataclasses import dataclass

from ddct_plant.checks import require_choice, require_number
from ddct_plant.errors import ParameterError
from ddct_plant.printed import PrintedNumber

Value = float | str
"""What is computed for a printed number, or the word for a printed word."""

REPRODUCED = 'reproduced'
CALIBRATED = 'calibrated'
PREDICTED = 'predicted'
ERRATUM = 'erratum'
NOT_REPRODUCIBLE = 'not_reproducible'
VERDICTS = (REPRODUCED, CALIBRATED, PREDICTED, ERRATUM, NOT_REPRODUCIBLE)
"""
What can be said of a printed number.

`reproduced`: computed here from other numbers. `calibrated`: parameters were fitted to it.
`predicted`: it comes from what was fitted to other numbers. `erratum`: the computation confirms
another value. `not_reproducible`: nothing computes it, it is an input of the thesis or has no
defined scale.
"""
COMPUTED_VERDICTS = (REPRODUCED, CALIBRATED, PREDICTED, ERRATUM)


@dataclass(frozen=True)
class Tolerance:
    """How far a number may lie from the printed one: the widest of the parts that are given."""

    half_units: float = 0.0
    """In halves of a unit of the last printed digit; 1 is the rounding of the print."""
    relative: float = 0.0
    """As a fraction of the printed number."""
    absolute: float = 0.0
    """In the number's own unit."""

    def __post_init__(self) -> None:
        """Check the parts; raise ParameterError when none is given or one is negative."""
        for name in ('half_units', 'relative', 'absolute'):
            require_number(f'tolerance: {name}', getattr(self, name), at_least=0.0)
        if self.half_units == self.relative == self.absolute == 0.0:
            raise ParameterError('tolerance: give half_units, relative or absolute, above 0')

    def around(self, printed: str) -> float:
        """Return the tolerance of a printed number in its own unit."""
        number = PrintedNumber('', printed)
        return max(
            self.half_units * number.half_unit, self.relative * abs(number.value), self.absolute
        )


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
    """None for words, which must be equal."""
    ours: str | None = None
    """Our value of an erratum or a prediction, to the digits that must come out; or a word."""

    def __post_init__(self) -> None:
        """Check that the claim is complete; raise ParameterError that names what is not."""
        try:
            require_choice('verdict', self.verdict, VERDICTS)
            self._require_complete()
        except ParameterError as error:
            raise ParameterError(f'{self.section}, {self.item}: {error}') from error

    @property
    def is_number(self) -> bool:
        """Whether a number is printed, not a word."""
        return is_number(self.printed)

    @property
    def absolute_tolerance(self) -> float | None:
        """The tolerance in the number's unit, None without one."""
        return self.tolerance.around(self.printed) if self.tolerance else None

    def _require_complete(self) -> None:
        if not self.reason.strip():
            raise ParameterError('give a reason')
        computed = self.verdict in COMPUTED_VERDICTS
        if computed != (self.id is not None):
            need = 'needs' if computed else 'has no'
            raise ParameterError(f'verdict {self.verdict} {need} id')
        if computed and self.is_number != (self.tolerance is not None):
            raise ParameterError('a computed number needs a tolerance, a word has none')
        if (self.verdict in (ERRATUM, PREDICTED)) != (self.ours is not None):
            raise ParameterError('give `ours` with an erratum or a prediction, not otherwise')


def is_number(text: str) -> bool:
    """Return whether the text is a number."""
    try:
        float(text)
    except ValueError:
        return False
    return True
