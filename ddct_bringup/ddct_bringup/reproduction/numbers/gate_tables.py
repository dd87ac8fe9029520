# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rows of the gate as tables of text, for the terminal and the page of documentation."""

import math
from collections import Counter, defaultdict
from collections.abc import Callable, Sequence
from operator import attrgetter

from ddct_bringup.reproduction.numbers.gate import OUTCOMES, GateRow
from ddct_bringup.reproduction.numbers.thesis_number import ERRATUM, Finding, is_number
from ddct_plant.models.printed import PrintedNumber
from ddct_plant.program.table import TextColumn, TextTable, Weight, table_of

_LEAST_DIGITS = 3
"""Least number of digits that count in a computed number."""
_CHAPTERS = ('1', '2', '3', '4', '5', '6')


def page_tables(rows: Sequence[GateRow]) -> dict[str, TextTable]:
    """Return every table of the documentation page by name."""
    errata = [row for row in rows if row.number.verdict == ERRATUM]
    return {
        'facts': facts_table(rows),
        'summary': summary_table(rows),
        'errata': table_of('Errata of the thesis', _ERRATUM_COLUMNS, errata, _COMPLETE),
        **chapter_tables(rows, reasons=True),
    }


def summary_table(rows: Sequence[GateRow]) -> TextTable:
    """Return how many numbers of each chapter have each verdict."""
    counts = Counter((_chapter(row), row.outcome) for row in rows)
    counts.update(('all', row.outcome) for row in rows)
    chapters = (*_CHAPTERS, 'all')
    lines = [
        (outcome, *(str(counts[chapter, outcome]) for chapter in chapters)) for outcome in OUTCOMES
    ]
    headers = ('verdict', *(f'chapter {chapter}' for chapter in _CHAPTERS), 'all')
    return TextTable('Printed numbers by verdict', headers, lines)


def facts_table(rows: Sequence[GateRow]) -> TextTable:
    """Return the number of distinct facts by outcome."""
    numbers, facts = Counter(row.outcome for row in rows), count_facts(rows)
    lines = [(outcome, str(numbers[outcome]), str(facts[outcome])) for outcome in OUTCOMES]
    total = ('all', str(len(rows)), str(facts.total()))
    headers = ('verdict', 'entries', 'distinct facts')
    return TextTable('Entries and distinct facts', headers, [*lines, total])


def misses_table(rows: Sequence[GateRow]) -> TextTable:
    """Return the misses, one row per section and reason, with that reason."""
    found: dict[tuple[str, str], list[str]] = defaultdict(list)
    for row in rows:
        if row.outcome.endswith('miss'):
            found[row.number.section, row.number.reason].append(row.number.item)
    lines = [(section, _joined(items), reason) for (section, reason), items in found.items()]
    headers = ('section', 'misses', 'rule, and what decides it')
    return TextTable('Misses', headers, lines, weights=(Weight.IDENTIFYING, Weight.NEEDED))


def _joined(items: Sequence[str]) -> str:
    """Return items with one semicolon between; a beginning such as `LS8: ` is said once."""
    found: dict[str, list[str]] = defaultdict(list)
    for item in items:
        beginning, colon, rest = item.rpartition(': ')
        found[beginning + colon].append(rest)
    return '; '.join(beginning + '; '.join(rests) for beginning, rests in found.items())


def count_facts(rows: Sequence[GateRow]) -> Counter[str]:
    """Return the number of groups by outcome: the worst of its numbers, so every miss shows."""
    outcomes: dict[str, list[str]] = defaultdict(list)
    for row in rows:
        outcomes[row.number.fact].append(row.outcome)
    return Counter(
        next((one for one in found if one == ERRATUM or one.endswith('miss')), found[0])
        for found in outcomes.values()
    )


def chapter_tables(rows: Sequence[GateRow], *, reasons: bool) -> dict[str, TextTable]:
    """Return one table per chapter by the name `chapter_N`; `reasons` adds groups and reasons."""
    return {
        f'chapter_{chapter}': table_of(
            f'Chapter {chapter}',
            (*_COLUMNS, *_REASON_COLUMNS) if reasons else _COLUMNS,
            [row for row in rows if _chapter(row) == chapter],
            _COMPLETE,
            () if reasons else (f'the group and reason of each: {_COMPLETE}',),
        )
        for chapter in _CHAPTERS
    }


def computed_text(row: GateRow) -> str | None:
    """
    Return the computed value, or None without one.

    A number has one digit more than the print, and at least three digits that count; a whole
    number has none after the point.
    """
    value = row.computed
    if isinstance(value, Finding):
        return value.evidence
    if value is None or isinstance(value, str):
        return value or None
    if value == round(value):
        return f'{value:.0f}'
    stated = [text for text in (row.number.printed, row.number.ours) if text and is_number(text)]
    half_unit = min(PrintedNumber('', text).half_unit for text in stated)
    of_print = 1 - math.ceil(math.log10(half_unit))
    of_value = _LEAST_DIGITS - 1 - math.floor(math.log10(abs(value)))
    digits = max(of_print, min(of_value, of_print + _LEAST_DIGITS))
    return f'{round(value, digits):.{max(digits, 0)}f}'


def _chapter(row: GateRow) -> str:
    return row.number.section[:1]


def _not_computed(row: GateRow) -> str:
    """Return the reason for which a number has no computed value."""
    return {
        'given': 'an input of the thesis, which nothing is computed for',
        'not_reproducible': 'the thesis does not print the inputs of this result',
    }.get(row.number.verdict, 'our model has no such value')


def _no_tolerance(row: GateRow) -> str:
    """Return the reason for which a number has no tolerance."""
    if row.computed is None:
        return _not_computed(row)
    return 'a statement, which holds or does not'


_GateColumn = TextColumn[GateRow]


def _text(
    heading: str, value: Callable[[GateRow], str | None], weight: Weight = Weight.NEEDED
) -> _GateColumn:
    return TextColumn(heading, '', value, number=False, undefined=_not_computed, weight=weight)


_COMPLETE = '--json FILE'
_VALUE_COLUMNS = (
    _text('section', attrgetter('number.section'), Weight.IDENTIFYING),
    _text('item', attrgetter('number.item'), Weight.IDENTIFYING),
    _text('printed', attrgetter('number.printed')),
    _text('computed', computed_text),
    _text('unit', attrgetter('number.unit'), Weight.USEFUL),
)
_COLUMNS = (
    *_VALUE_COLUMNS[:2],
    _text('verdict', attrgetter('outcome')),
    *_VALUE_COLUMNS[2:],
    TextColumn(
        'tolerance',
        '.3g',
        attrgetter('number.absolute_tolerance'),
        undefined=_no_tolerance,
        weight=Weight.DETAIL,
    ),
)
_GROUP: _GateColumn = TextColumn(
    'group',
    '',
    lambda row: row.number.group or None,
    number=False,
    undefined=lambda row: 'the number has no group',
    weight=Weight.DETAIL,
)
_REASON_COLUMNS = (_GROUP, _text('reason', attrgetter('number.reason')))
_ERRATUM_COLUMNS = (*_VALUE_COLUMNS, _GROUP, _text('what is wrong', attrgetter('number.reason')))
