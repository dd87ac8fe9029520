# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rows of the gate as tables of text, for the terminal and the page of documentation."""

from collections import Counter, defaultdict
from collections.abc import Callable, Mapping, Sequence
from operator import attrgetter

from ddct_bringup.reproduction.numbers.gate import OUTCOMES, GateRow
from ddct_bringup.reproduction.numbers.thesis_number import ERRATUM, Finding, is_number
from ddct_plant.models.printed import PrintedNumber
from ddct_plant.program.table import Table, text_or_dash

_CHAPTERS = ('1', '2', '3', '4', '5', '6')


def page_tables(rows: Sequence[GateRow]) -> dict[str, Table]:
    """Return every table of the documentation page by name."""
    errata = [row for row in rows if row.number.verdict == ERRATUM]
    return {
        'facts': facts_table(rows),
        'summary': summary_table(rows),
        'errata': _table('Errata of the thesis', _ERRATUM_CELLS, errata),
        **chapter_tables(rows, reasons=True),
    }


def summary_table(rows: Sequence[GateRow]) -> Table:
    """Return how many numbers of each chapter have each verdict."""
    counts = Counter((_chapter(row), row.outcome) for row in rows)
    counts.update(('all', row.outcome) for row in rows)
    lines = [
        (chapter, *(str(counts[chapter, outcome]) for outcome in OUTCOMES))
        for chapter in (*_CHAPTERS, 'all')
    ]
    return Table('Printed numbers by verdict', ('chapter', *OUTCOMES), lines)


def facts_table(rows: Sequence[GateRow]) -> Table:
    """Return the number of distinct facts by outcome."""
    numbers, facts = Counter(row.outcome for row in rows), count_facts(rows)
    lines = [(outcome, str(numbers[outcome]), str(facts[outcome])) for outcome in OUTCOMES]
    total = ('all', str(len(rows)), str(facts.total()))
    headers = ('verdict', 'entries', 'distinct facts')
    return Table('Entries and distinct facts', headers, [*lines, total])


def count_facts(rows: Sequence[GateRow]) -> Counter[str]:
    """Return the number of groups by outcome: the worst of its numbers, so every miss shows."""
    outcomes: dict[str, list[str]] = defaultdict(list)
    for row in rows:
        outcomes[row.number.fact].append(row.outcome)
    return Counter(
        next((one for one in found if one == ERRATUM or one.endswith('miss')), found[0])
        for found in outcomes.values()
    )


def chapter_tables(rows: Sequence[GateRow], *, reasons: bool) -> dict[str, Table]:
    """Return one table per chapter by the name `chapter_N`; `reasons` adds groups and reasons."""
    return {
        f'chapter_{chapter}': _table(
            f'Chapter {chapter}',
            {**_CELLS, **_REASON_CELLS} if reasons else _CELLS,
            [row for row in rows if _chapter(row) == chapter],
        )
        for chapter in _CHAPTERS
    }


def computed_text(row: GateRow) -> str:
    """Return the computed value with one digit more than the print; - without one."""
    value = row.computed
    if isinstance(value, Finding):
        return value.evidence
    if value is None or isinstance(value, str):
        return value or '-'
    if not row.hit and row.number.verdict != ERRATUM:
        return f'{value:.5g}'
    stated = [text for text in (row.number.printed, row.number.ours) if text and is_number(text)]
    unit = min(PrintedNumber('', text).half_unit for text in stated) / 5.0
    return f'{round(value / unit) * unit:.7g}'


def _tolerance_text(row: GateRow) -> str:
    return text_or_dash(row.number.absolute_tolerance, '.3g')


def _group_text(row: GateRow) -> str:
    return row.number.group or '-'


def _chapter(row: GateRow) -> str:
    return row.number.section[:1]


_Cells = Mapping[str, Callable[[GateRow], str]]
"""Functions that return the cell of a row, by header."""
_VALUE_CELLS: _Cells = {
    'section': attrgetter('number.section'),
    'item': attrgetter('number.item'),
    'printed': attrgetter('number.printed'),
    'computed': computed_text,
    'unit': attrgetter('number.unit'),
}
_CELLS: _Cells = {**_VALUE_CELLS, 'tolerance': _tolerance_text, 'verdict': attrgetter('outcome')}
_REASON_CELLS: _Cells = {'group': _group_text, 'reason': attrgetter('number.reason')}
_ERRATUM_CELLS: _Cells = {
    **_VALUE_CELLS,
    'group': _group_text,
    'what is wrong': attrgetter('number.reason'),
}


def _table(title: str, cells: _Cells, rows: Sequence[GateRow]) -> Table:
    return Table(
        title, tuple(cells), [tuple(cell(row) for cell in cells.values()) for row in rows]
    )
