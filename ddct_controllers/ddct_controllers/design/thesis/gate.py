"""The gate: hold every claim about a printed number against what is computed."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ddct_controllers.design.thesis.thesis_number import (
    CALIBRATED,
    ERRATUM,
    REPRODUCED,
    ThesisNumber,
    Tolerance,
    Value,
    is_number,
)
from ddct_plant.errors import ParameterError

_UNCOMPUTED = 'nothing was computed for it (closed loops need ddct_bringup, installed)'
_ROUNDING = Tolerance(half_units=1.0)


@dataclass(frozen=True)
class GateRow:
    """One printed number beside the computed one."""

    number: ThesisNumber
    computed: Value | None
    complaint: str | None
    """Why the claim does not hold, None when it does."""

    def as_dict(self) -> dict[str, Any]:
        """Return what `design thesis --json` writes for it; what is not there is None."""
        number = self.number
        return {
            'section': number.section,
            'item': number.item,
            'printed': float(number.printed) if number.is_number else number.printed,
            'computed': self.computed,
            'unit': number.unit,
            'tolerance': number.absolute_tolerance,
            'verdict': number.verdict,
            'reason': number.reason,
        }


def judge(
    numbers: Sequence[ThesisNumber], values: Mapping[str, Value | None]
) -> tuple[GateRow, ...]:
    """
    Return a row per number; `values` has what was computed, by the numbers' ids.

    Raise ParameterError for a value that no number of the file asks for.
    """
    unknown = sorted(values.keys() - {number.id for number in numbers})
    if unknown:
        raise ParameterError(f'computed, but not in the list of numbers: {", ".join(unknown)}')
    return tuple(_row(number, values) for number in numbers)


def _row(number: ThesisNumber, values: Mapping[str, Value | None]) -> GateRow:
    if number.id is None:
        return GateRow(number, None, None)
    value = values.get(number.id)
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return GateRow(number, None, _UNCOMPUTED)
    return GateRow(number, value, _complaint(number, value))


def _complaint(number: ThesisNumber, value: Value) -> str | None:
    as_printed = _agrees(value, number.printed, number.tolerance)
    if number.verdict in (REPRODUCED, CALIBRATED) and not as_printed:
        return f'{_text(value)} is not within the tolerance of the printed {number.printed}'
    if number.verdict == ERRATUM and as_printed:
        return f'called an erratum, but {_text(value)} agrees with the print'
    if number.ours is not None and not _agrees(value, number.ours, _ROUNDING):
        return f'{_text(value)} is not the {number.ours} that the list gives as ours'
    return None


def _agrees(value: Value, stated: str, tolerance: Tolerance | None) -> bool:
    """Return whether a word is the stated one, or a number near the stated one."""
    if isinstance(value, str) or not is_number(stated) or tolerance is None:
        return value == stated
    # An allowance for floating point where a value lies on the edge, as 0.125 at 0.13.
    return abs(value - float(stated)) <= tolerance.around(stated) * (1.0 + 1e-9)


def _text(value: Value) -> str:
    return value if isinstance(value, str) else f'{value:.6g}'
