# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of all packaged controllers on the development cases, from the rows of the release."""

from collections.abc import Iterator, Mapping
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
from ddct_bringup.documents.document import Column, Document, Note, Row, Table
from ddct_bringup.documents.terminal import text_table
from ddct_bringup.evaluation.dominance import compare
from ddct_bringup.evaluation.grouped_rows import GroupedRows
from ddct_bringup.evaluation.quantities import MAIN
from ddct_bringup.evaluation.spread import QuantitySummary
from ddct_bringup.evaluation.summarise import summarise
from ddct_bringup.evaluation.summary import GroupSummary, Summary
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.program.table import Weight, WrittenTable

_HEADINGS = ('response s', 'jerk m/s^3', 'work kJ', 'A_w m/s^2', 'releases')
"""Headings of the five figures, in their order."""
_FORMS = ('.2f', '.1f', '.1f', '.2f', '.0f')
_FACTORS = (1.0, 1.0, 1e-3, 1.0, 1.0)
_CONTROLLER = Column('controller', number=False, weight=Weight.IDENTIFYING)
_ENGAGED = Column('engaged', number=False)
_OTHERS = Column('other states', number=False, missing='every run is engaged')
_OF_FIGURES = (
    _CONTROLLER,
    Column('of', number=False, weight=Weight.IDENTIFYING),
    *(
        Column(heading, form=form, missing=texts.NO_VALUE)
        for heading, form in zip(_HEADINGS, _FORMS, strict=True)
    ),
)


def packaged_document(tables: Mapping[str, Table]) -> Document:
    """Return the document of `packaged_tables`: the tables, and the rules below."""
    return Document(
        'Benchmark',
        'The packaged controllers',
        'From the rows of the release',
        [*tables.values(), *map(Note, packaged_lines())],
    )


def packaged_written(tables: Mapping[str, Table]) -> Mapping[str, WrittenTable]:
    """Return what `--packaged --json` writes of `packaged_tables`: their cells as texts."""
    return {name: text_table(table).written for name, table in tables.items()}


def packaged_tables() -> Mapping[str, Table]:
    """
    Return the tables of all cases and of each scenario by name, a row for each controller.

    `all` has the states and `dominance` who dominates whom; SCENARIO has the states there, and
    SCENARIO_figures the figures of the successes.
    """
    rows = release_rows(packaged_folder()).rows
    varied = tuple(Cases.packaged().whole.vary)
    every = summarise(rows.table, rows.by(varied, dominance=True))
    columns = (_CONTROLLER, _ENGAGED, Column('95 % interval', number=False), _OTHERS)
    tables = {
        'all': Table('All development cases', columns, list(_overall(every))),
        'dominance': _dominance(every),
    }
    names = np.array(rows.rows[SCENARIO].to_pylist()[: rows.cases])
    for name in dict.fromkeys(names.tolist()):
        of_scenario = rows.of_cases(np.flatnonzero(names == name))
        part = summarise(of_scenario.table, of_scenario.by(varied))
        tables[name] = Table(
            f'Development cases of {name}',
            (_CONTROLLER, _ENGAGED, _OTHERS),
            [(each.controller, *_state_cells(each)) for each in part.groups],
        )
        tables[f'{name}_figures'] = Table(
            f'Successes in development cases of {name}', _OF_FIGURES, list(_figure_rows(part))
        )
    return tables


def packaged_lines() -> Iterator[str]:
    """Yield how many cases are compared, then the rules on what counts and on tricks."""
    rules = packaged_limits().rules
    yield _compared_cases(release_rows(packaged_folder()).rows)
    yield 'What counts:'
    for meanings in (states_that_count(rules), figures_that_count()):
        yield from (f'  {name}: {meaning}' for name, meaning in meanings.items())
    yield 'Nobody gains by what follows:'
    yield from (f'  {each}' for each in NO_GAIN)
    yield left_open(rules)


def _overall(summary: Summary) -> Iterator[Row]:
    for group in summary.groups:
        engaged, others = _state_cells(group)
        yield group.controller, engaged, group.engaged.interval_text, others


def _state_cells(group: GroupSummary) -> tuple[str, str | None]:
    """Return the engaged runs, and the other states with their numbers."""
    return f'{group.engaged.count} of {group.runs}', texts.states_text(group) or None


def _figure_rows(summary: Summary) -> Iterator[Row]:
    """Yield P50, P95 and worst of each controller's figures, a row each."""
    for group in summary.groups:
        spreads = [
            _spread(group.quantities.get(key), factor)
            for key, factor in zip(MAIN, _FACTORS, strict=True)
        ]
        for of, row in zip(('P50', 'P95', 'worst'), zip(*spreads, strict=True), strict=True):
            yield group.controller, of, *row


def _spread(found: QuantitySummary | None, factor: float) -> tuple[float | None, ...]:
    """Return P50, P95 and worst of the successes, times a factor."""
    if found is None or found.worst_engaged is None:
        return None, None, None
    values = found.quantiles.p50, found.quantiles.p95, found.worst_engaged.value
    return tuple(None if value is None else factor * value for value in values)


def _dominance(summary: Summary) -> Table:
    """Return how many controllers each one dominates, and which dominate it."""
    dominators = {group.controller: group.dominated_by or () for group in summary.groups}
    columns = (
        _CONTROLLER,
        Column('dominates'),
        Column('dominated by'),
        Column('the first of these', number=False, missing='no controller dominates it'),
    )
    rows = []
    for name, ours in dominators.items():
        dominated = sum(name in others for others in dominators.values())
        rows.append((name, dominated, len(ours), ', '.join(ours[:3]) or None))
    return Table('Who dominates whom in all development cases', columns, rows)


def _compared_cases(rows: CaseRows) -> str:
    """Return how many cases the dominance is of, and how many are left out of each figure."""
    grouped = GroupedRows(rows.table, rows.by(()))
    figures = [grouped.case_figures(group) for group in grouped.groups]
    comparisons = (compare(*pair) for pair in combinations(figures, 2))
    return (
        f'dominance is of {rows.cases} cases, left out of a pair at most: '
        f'{texts.left_out_text(comparisons)}'
    )
