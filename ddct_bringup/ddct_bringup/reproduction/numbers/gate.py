# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Thesis gate: read the claims about printed numbers in `chapters/`, and check them."""

import importlib.resources
import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
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
from ddct_plant.files.yaml_text import parse_yaml

_KEYS = frozenset(field.name for field in fields(ThesisNumber))
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

    def as_dict(self) -> Mapping[str, object]:
        """Return the entry in `ddct reproduce numbers --json`; missing values are None."""
        number, value = self.number, self.computed
        return {
            'section': number.section,
            'item': number.item,
            'printed': float(number.printed) if number.is_number else number.printed,
            'computed': value.evidence if isinstance(value, Finding) else value,
            'unit': number.unit,
            'tolerance': number.absolute_tolerance,
            'verdict': number.verdict,
            'hit': self.hit,
            'group': number.fact,
            'reason': number.reason,
        }


def thesis_numbers() -> tuple[ThesisNumber, ...]:
    """Return every number of the files in the order of the sections."""
    folder = importlib.resources.files('ddct_bringup.reproduction.numbers') / 'chapters'
    chapters = sorted(file.name for file in folder.iterdir())
    return parse_numbers('\n'.join((folder / name).read_text('utf-8') for name in chapters))


def parse_numbers(text: str) -> tuple[ThesisNumber, ...]:
    """
    Return the numbers in the YAML text, in the order of the sections.

    It is a list of blocks; each has a list `numbers` of entries, and any other key is a default
    for all of them. Raise ParameterError for an unknown key, an incomplete claim or a repeated
    one, and for a group whose numbers have different rules.
    """
    numbers = [
        _number(entry, defaults=block) for block in parse_yaml(text) for entry in block['numbers']
    ]
    names = Counter(f'{number.section}, {number.item}' for number in numbers)
    repeated = [name for name, count in names.items() if count > 1]
    if repeated:
        raise ParameterError(f'given twice: {"; ".join(repeated)}')
    _require_one_rule(numbers)
    return tuple(sorted(numbers, key=_place))


def _place(number: ThesisNumber) -> tuple[int, ...]:
    """Return the section as numbers, without a suffix after a comma, such as a table."""
    digits = number.section.partition(',')[0]
    try:
        return tuple(int(part) for part in digits.split('.'))
    except ValueError:
        raise ParameterError(f'section {number.section!r}: begin with numbers, 3.2') from None


def _number(own: Mapping[str, Any], defaults: Mapping[str, Any]) -> ThesisNumber:
    entry = {key: value for key, value in defaults.items() if key != 'numbers'}
    entry.update(own)
    name = f'{entry.get("section")}, {entry.get("item")}'
    unknown = sorted(entry.keys() - _KEYS)
    if unknown:
        raise ParameterError(f'{name}: unknown key {", ".join(unknown)}')
    for key, value in entry.items():
        if key != 'tolerance' and not isinstance(value, str):
            raise ParameterError(f'{name}: {key} is {value!r}: put it in quotes')
    tolerance = entry.pop('tolerance', None)
    try:
        return ThesisNumber(**entry, tolerance=Tolerance(**tolerance) if tolerance else None)
    except TypeError as error:
        raise ParameterError(f'{name}: {error}') from error


def _require_one_rule(numbers: Iterable[ThesisNumber]) -> None:
    """
    Raise ParameterError for a group whose numbers have different rules.

    All numbers of a group have one kind of source, so that none is without a computed value while
    others have one; those of one unit have one tolerance.
    """
    found: dict[str, set[str | Tolerance]] = defaultdict(set)
    for number in numbers:
        group = f'group {number.fact!r}'
        of_the_print = number.verdict in (REPRODUCED, ERRATUM)
        kind = 'reproduced or erratum' if of_the_print else number.verdict
        found[f'{group}: verdicts of different kinds'].add(kind)
        if number.tolerance:
            found[f'{group}: more than one tolerance in {number.unit}'].add(number.tolerance)
    for complaint, values in found.items():
        if len(values) > 1:
            raise ParameterError(f'{complaint}: {sorted(str(value) for value in values)}')


def judge(
    numbers: Sequence[ThesisNumber], values: Mapping[str, Value | None]
) -> tuple[GateRow, ...]:
    """
    Return a row per number; `values` are the computed values, by the numbers' ids.

    Raise ParameterError for a value without a number in the file: every computed value is listed.
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
