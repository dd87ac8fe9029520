"""The gate: hold every claim about a printed number against what is computed."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ddct_bringup.reproduction.numbers.thesis_number import (
    ERRATUM,
    REPRODUCED,
    Finding,
    ThesisNumber,
    Tolerance,
    Value,
    is_number,
)
from ddct_bringup.thesis.table_5_1 import CALIBRATED, PREDICTED
from ddct_plant.base.errors import ParameterError

_ROUNDING = Tolerance(half_units=1.0)
OUTCOMES = (
    *('reproduced', 'erratum', 'calibrated hit', 'calibrated miss'),
    *('predicted hit', 'predicted miss', 'given', 'not_reproducible'),
)
"""The verdicts, with hit or miss where both can be."""


@dataclass(frozen=True)
class GateRow:
    """One printed number beside the computed one."""

    number: ThesisNumber
    computed: Value | None
    complaint: str | None
    """Why the claim does not hold, None when it does."""
    hit: bool | None
    """Whether computed and printed agree; None when nothing computes it."""

    @property
    def outcome(self) -> str:
        """One of OUTCOMES."""
        verdict = self.number.verdict
        if verdict not in (CALIBRATED, PREDICTED):
            return verdict
        return f'{verdict} {"hit" if self.hit else "miss"}'

    def as_dict(self) -> dict[str, Any]:
        """Return what `ddct reproduce numbers --json` writes for it; what is not there is None."""
        number, value = self.number, self.computed
        return {
            'section': number.section,
            'item': number.item,
            'printed': float(number.printed) if number.is_number else number.printed,
            'computed': value.figures if isinstance(value, Finding) else value,
            'unit': number.unit,
            'tolerance': number.absolute_tolerance,
            'verdict': number.verdict,
            'hit': self.hit,
            'group': number.fact,
            'reason': number.reason,
        }


def judge(
    numbers: Sequence[ThesisNumber], values: Mapping[str, Value | None]
) -> tuple[GateRow, ...]:
    """
    Return a row per number; `values` has what was computed, by the numbers' ids.

    Raise ParameterError for a value that no number of the file asks for: what a computation
    yields is listed whole.
    """
    unknown = sorted(values.keys() - {number.id for number in numbers})
    if unknown:
        raise ParameterError(f'computed, but not in the list of numbers: {", ".join(unknown)}')
    return tuple(_row(number, values) for number in numbers)


def _row(number: ThesisNumber, values: Mapping[str, Value | None]) -> GateRow:
    if number.id is None:
        return GateRow(number, None, None, None)
    value = values.get(number.id)
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return GateRow(number, None, 'nothing was computed for it', None)
    if isinstance(value, float) and number.is_number and number.tolerance is None:
        return GateRow(number, value, 'a computed number needs a tolerance', None)
    hit = _agrees(value, number.printed, number.tolerance)
    return GateRow(number, value, _complaint(number, value, hit), hit)


def _complaint(number: ThesisNumber, value: Value, hit: bool) -> str | None:
    expected = number.verdict == REPRODUCED or number.hit != 'no'
    if number.verdict in (REPRODUCED, CALIBRATED) and hit != expected:
        within = 'within' if hit else 'not within'
        return f'{_text(value)} is {within} the tolerance of the printed {number.printed}'
    if number.verdict == ERRATUM and hit:
        return f'called an erratum, but {_text(value)} agrees with the print'
    if number.ours is not None and not _agrees(value, number.ours, _ROUNDING):
        return f'{_text(value)} is not the {number.ours} that the list gives as ours'
    return None


def _agrees(value: Value, stated: str, tolerance: Tolerance | None) -> bool:
    """Return whether a word is the stated one, a number near it, or a claim holds."""
    if isinstance(value, Finding):
        return value.holds
    if isinstance(value, str) or not is_number(stated) or tolerance is None:
        return value == stated
    # An allowance for floating point where a value lies on the edge, as 0.125 at 0.13.
    return abs(value - float(stated)) <= tolerance.around(stated) * (1.0 + 1e-9)


def _text(value: Value) -> str:
    if isinstance(value, Finding):
        return value.figures
    return value if isinstance(value, str) else f'{value:.6g}'
