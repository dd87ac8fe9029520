# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Claims about printed numbers, read from the files in `chapters/`."""

import importlib.resources
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import fields
from typing import Any

from ddct_bringup.reproduction.numbers.thesis_number import (
    ERRATUM,
    REPRODUCED,
    ThesisNumber,
    Tolerance,
)
from ddct_plant.base.errors import ParameterError
from ddct_plant.files.yaml_text import parse_yaml

_KEYS = frozenset(field.name for field in fields(ThesisNumber))


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
