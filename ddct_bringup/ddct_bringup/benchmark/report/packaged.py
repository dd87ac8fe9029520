# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of all packaged controllers on the development cases, from the rows of the release."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from ddct_bringup.benchmark.case_rows import CaseRows
from ddct_bringup.benchmark.cases import Cases, packaged_folder
from ddct_bringup.benchmark.release import release_rows
from ddct_bringup.benchmark.report import texts
from ddct_bringup.benchmark.report.rules import (
    NO_GAIN,
    figures_that_count,
    left_open,
    states_that_count,
)
from ddct_bringup.campaign.keys import SCENARIO
from ddct_bringup.evaluation.dominance import compare
from ddct_bringup.evaluation.grouped_rows import GroupedRows
from ddct_bringup.evaluation.quantities import MAIN
from ddct_bringup.evaluation.spread import QuantitySummary
from ddct_bringup.evaluation.summarise import summarise
from ddct_bringup.evaluation.summary import GroupSummary, Summary
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.program.table import UNDEFINED, TextTable, Weight, with_reasons

_STATES = 'controller', 'engaged', 'other states'
_HEADINGS = ('response s', 'jerk m/s^3', 'work kJ', 'A_w m/s^2', 'releases')
"""Headings of the five figures, in their order."""
_FORMS = tuple(
    zip(MAIN, ('.2f', '.1f', '.1f', '.2f', '.0f'), (1.0, 1.0, 1e-3, 1.0, 1.0), strict=True)
)
"""Key, format and factor of each column."""


def packaged_tables() -> Mapping[str, TextTable]:
    """
    Return the tables of all cases and of each scenario by name, a row for each controller.

    `all` has the states and `dominance` who dominates whom; SCENARIO has the states there, and
    SCENARIO_figures the figures of the successes.
    """
    rows = release_rows(packaged_folder()).rows
    varied = tuple(Cases.packaged().whole.vary)
    every = summarise(rows.table, rows.by(varied, dominance=True))
    tables = {
        'all': TextTable('All development cases', _headers_of_all(), list(_overall(every))),
        'dominance': _dominance(every),
    }
    names = np.array(rows.rows[SCENARIO].to_pylist()[: rows.cases])
    for name in dict.fromkeys(names.tolist()):
        of_scenario = rows.of_cases(np.flatnonzero(names == name))
        part = summarise(of_scenario.table, of_scenario.by(varied))
        tables[name] = TextTable(
            f'Development cases of {name}',
            _STATES,
            [(each.controller, *_state_cells(each)) for each in part.groups],
        )
        tables[f'{name}_figures'] = TextTable(
            f'Successes in development cases of {name}',
            ('controller', 'of', *_HEADINGS),
            list(_figure_rows(part)),
            numbers=(False, False, *(True for _ in _HEADINGS)),
            weights=(Weight.IDENTIFYING, Weight.IDENTIFYING),
        )
    return {name: _complete(table) for name, table in tables.items()}


def _complete(table: TextTable) -> TextTable:
    """Return a table with the reasons of its dashes, and the option that writes all of it."""
    return replace(with_reasons(table, _dash_reason), complete='--json FILE')


def _dash_reason(header: str, row: Sequence[str]) -> str:
    """Return the reason of a dash by its column."""
    return {
        'other states': 'every run is engaged',
        'the first of these': 'no controller dominates it',
    }.get(header, texts.NO_VALUE)


def packaged_lines() -> Iterator[str]:
    """Yield how many cases are compared, then what counts, what nobody gains by, what is open."""
    rules = packaged_limits().rules
    yield _compared_cases(release_rows(packaged_folder()).rows)
    yield 'What counts:'
    for meanings in (states_that_count(rules), figures_that_count()):
        yield from (f'  {name}: {meaning}' for name, meaning in meanings.items())
    yield 'Nobody gains by what follows:'
    yield from (f'  {each}' for each in NO_GAIN)
    yield left_open(rules)


def _headers_of_all() -> tuple[str, ...]:
    return (*_STATES[:2], '95 % interval', *_STATES[2:])


def _overall(summary: Summary) -> Iterator[tuple[str, ...]]:
    for group in summary.groups:
        engaged, others = _state_cells(group)
        yield group.controller, engaged, group.engaged.interval_text, others


def _state_cells(group: GroupSummary) -> tuple[str, str]:
    """Return the engaged runs, and the other states with their numbers."""
    return f'{group.engaged.count} of {group.runs}', texts.states_text(group) or '-'


def _figure_rows(summary: Summary) -> Iterator[tuple[str, ...]]:
    """Yield P50, P95 and worst of each controller's figures, a row each."""
    for group in summary.groups:
        cells = [
            _spread_texts(group.quantities.get(key), form, factor) for key, form, factor in _FORMS
        ]
        for of, row in zip(('P50', 'P95', 'worst'), zip(*cells, strict=True), strict=True):
            yield group.controller, of, *row


def _spread_texts(
    found: QuantitySummary | None, form: str, factor: float = 1.0
) -> tuple[str, str, str]:
    """Return P50, P95 and worst of the successes, times a factor."""
    if found is None or found.worst_engaged is None:
        return UNDEFINED, UNDEFINED, UNDEFINED
    values = found.quantiles.p50, found.quantiles.p95, found.worst_engaged.value
    p50, p95, worst = (
        UNDEFINED if value is None else f'{factor * value:{form}}' for value in values
    )
    return p50, p95, worst


def _dominance(summary: Summary) -> TextTable:
    """Return how many controllers each one dominates, and which dominate it."""
    dominators = {group.controller: group.dominated_by or () for group in summary.groups}
    found = []
    for name, ours in dominators.items():
        dominated = sum(name in others for others in dominators.values())
        found.append((name, str(dominated), str(len(ours)), ', '.join(ours[:3]) or '-'))
    headers = 'controller', 'dominates', 'dominated by', 'the first of these'
    return TextTable('Who dominates whom in all development cases', headers, found)


def _compared_cases(rows: CaseRows) -> str:
    """Return how many cases the dominance is of, and how many are left out of each figure."""
    grouped = GroupedRows(rows.table, rows.by(()))
    figures = [grouped.case_figures(group) for group in grouped.groups]
    comparisons = (compare(*pair) for pair in combinations(figures, 2))
    return (
        f'dominance is of {rows.cases} cases, left out of a pair at most: '
        f'{texts.left_out_text(comparisons)}'
    )
