"""Read the gate's files, `chapters/`: blocks of numbers that share a section or a reason."""

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
    Return the numbers that the YAML text lists, in the order of the sections.

    It is a list of blocks; each has a list `numbers` of entries, and any other key as default of
    all of them. Raise ParameterError for an unknown key, an incomplete claim or a repeated one,
    and for a group that does not treat its numbers alike.
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
    """Return the section as numbers, without what follows a comma in it, such as a table."""
    digits = number.section.partition(',')[0]
    try:
        return tuple(int(part) for part in digits.split('.'))
    except ValueError:
        raise ParameterError(f'section {number.section!r}: begin with numbers, 3.2') from None


def _number(own: Mapping[str, Any], defaults: Mapping[str, Any]) -> ThesisNumber:
    entry = {**defaults, **own}
    del entry['numbers']
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
    Raise ParameterError for a group that does not treat its numbers alike.

    All numbers of a group come from one kind of source, so that none can stand without a computed
    value beside others that have one, and those of one unit have one tolerance.
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
