# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Thesis gate: computed values beside the claims about printed numbers."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

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
from ddct_plant.program.table import WrittenTable

_ROUNDING = Tolerance(half_units=1.0)
LEAST_OF_ERRATUM = 2.0
"""
Smallest distance of an erratum from the print, in tolerances.

A smaller deviation is a miss: a slightly wider tolerance would have accepted it.
"""
OUTCOMES = (
    *('reproduced', 'erratum', 'calibrated hit', 'calibrated miss'),
    *('predicted hit', 'predicted miss', 'given', 'not_reproducible'),
)
"""Possible outcomes: the verdicts, with hit or miss where both can occur."""


@dataclass(frozen=True)
class NumberEntry:
    """One printed number with the computed one, as JSON and CSV have it."""

    section: str
    """Section of the thesis."""
    item: str
    printed: float | str
    computed: float | str | None
    """None where nothing is computed."""
    unit: str
    tolerance: float | None
    """Largest difference in the unit; None for a statement."""
    verdict: str
    hit: bool | None
    """Whether computed and printed value agree; None without a computed value."""
    group: str
    """Fact that the number is a part of."""
    reason: str
    """Reason for the tolerance; for an erratum, the error; for others, why nothing is computed."""


@dataclass(frozen=True)
class NumbersDocument:
    """Document of `thesis numbers --json`."""

    numbers: Sequence[NumberEntry]
    tables: Mapping[str, WrittenTable]
    """Tables of the page on the numbers, by name."""


@dataclass(frozen=True)
class GateRow:
    """One printed number with the computed one."""

    number: ThesisNumber
    computed: Value | None
    complaint: str | None
    """Reason why the claim fails, None when it holds."""
    hit: bool | None
    """Whether computed and printed value agree; None without a computed value."""

    @property
    def outcome(self) -> str:
        """Outcome of the claim: one of OUTCOMES."""
        verdict = self.number.verdict
        if verdict not in (CALIBRATED, PREDICTED):
            return verdict
        return f'{verdict} {"hit" if self.hit else "miss"}'

    @property
    def entry(self) -> NumberEntry:
        """Entry in `ddct thesis numbers --json`."""
        number, value = self.number, self.computed
        return NumberEntry(
            section=number.section,
            item=number.item,
            printed=float(number.printed) if number.is_number else number.printed,
            computed=value.evidence if isinstance(value, Finding) else value,
            unit=number.unit,
            tolerance=number.absolute_tolerance,
            verdict=number.verdict,
            hit=self.hit,
            group=number.fact,
            reason=number.reason,
        )


def judge(
    numbers: Sequence[ThesisNumber], values: Mapping[str, Value | None]
) -> tuple[GateRow, ...]:
    """
    Return a row per number; `values` are the computed values, by the numbers' ids.

    Raise ParameterError for a value without a number in the file: every computed value is listed.
    """
    unknown = sorted(values.keys() - {number.id for number in numbers})
    if unknown:
        raise ParameterError(
            f'computed, but not in the list of numbers: {", ".join(unknown)}', key=unknown[0]
        )
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
    if number.verdict == ERRATUM and _misses_closely(value, number):
        return (
            f'called an erratum, but {_text(value)} is less than {LEAST_OF_ERRATUM:g} tolerances '
            f'from the printed {number.printed}: a miss'
        )
    if number.ours is not None and not _agrees(value, number.ours, _ROUNDING):
        return f'{_text(value)} is not the {number.ours} that the list gives as ours'
    return None


def _misses_closely(value: Value, number: ThesisNumber) -> bool:
    if not isinstance(value, float) or number.absolute_tolerance is None:
        return False
    return abs(value - float(number.printed)) < LEAST_OF_ERRATUM * number.absolute_tolerance


def _agrees(value: Value, stated: str, tolerance: Tolerance | None) -> bool:
    """Return whether text is equal to the stated text, a number is near it, or a claim holds."""
    if isinstance(value, Finding):
        return value.holds
    if isinstance(value, str) or not is_number(stated) or tolerance is None:
        return value == stated
    # The factor is a margin for rounding where a value is on the bound, as 0.125 at 0.13.
    return abs(value - float(stated)) <= tolerance.around(stated) * (1.0 + 1e-9)


def _text(value: Value) -> str:
    if isinstance(value, Finding):
        return value.evidence
    return value if isinstance(value, str) else f'{value:.6g}'
