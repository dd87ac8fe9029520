# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of all packaged controllers on the development cases, from the rows of the release."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from ddct_bringup.benchmark.case_rows import CaseRows
from ddct_bringup.benchmark.cases import packaged_folder
from ddct_bringup.benchmark.comparison import figures_in
from ddct_bringup.benchmark.evaluated import MAIN, Columns, values_of
from ddct_bringup.benchmark.evaluation import states_in
from ddct_bringup.benchmark.outcomes import share_of_successes, spread_in
from ddct_bringup.benchmark.release import release_rows
from ddct_bringup.benchmark.report import texts
from ddct_bringup.benchmark.report.printed import spread_texts
from ddct_bringup.benchmark.report.rules import (
    NO_GAIN,
    figures_that_count,
    left_open,
    states_that_count,
)
from ddct_bringup.benchmark.statistics.case_figures import FIGURES
from ddct_bringup.benchmark.statistics.dominance import compare, dominators_of
from ddct_bringup.campaign.keys import SCENARIO
from ddct_bringup.campaign_report.texts import interval_text, state_text
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import ENGAGED
from ddct_plant.program.table import Table, Weight, with_reasons

_STATES = 'controller', 'engaged', 'other states'
_HEADINGS = ('response s', 'jerk m/s^3', 'work kJ', 'A_w m/s^2', 'releases')
"""Headings of the five figures, in their order."""
_FORMS = tuple(
    zip(MAIN, ('.2f', '.1f', '.1f', '.2f', '.0f'), (1.0, 1.0, 1e-3, 1.0, 1.0), strict=True)
)
"""Key, format and factor of each column."""


def packaged_tables() -> Mapping[str, Table]:
    """
    Return the tables of all cases and of each scenario by name, a row for each controller.

    `all` has the states and `dominance` who dominates whom; SCENARIO has the states there, and
    SCENARIO_figures the figures of the successes.
    """
    rows = release_rows(packaged_folder()).rows
    tables = {
        'all': Table('All development cases', _headers_of_all(), list(_overall(rows))),
        'dominance': _dominance(rows),
    }
    names = rows.of(rows.controllers[0])[SCENARIO]
    for name in dict.fromkeys(names.tolist()):
        part = rows.of_cases(np.flatnonzero(names == name))
        tables[name] = Table(
            f'Development cases of {name}',
            _STATES,
            [(each, *_state_cells(part.of(each))) for each in part.controllers],
        )
        tables[f'{name}_figures'] = Table(
            f'Successes in development cases of {name}',
            ('controller', 'of', *_HEADINGS),
            list(_figure_rows(part)),
            numbers=(False, False, *(True for _ in _HEADINGS)),
            weights=(Weight.IDENTIFYING, Weight.IDENTIFYING),
        )
    return {name: _complete(table) for name, table in tables.items()}


def _complete(table: Table) -> Table:
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


def _overall(rows: CaseRows) -> Iterator[tuple[str, ...]]:
    for name in rows.controllers:
        columns = rows.of(name)
        engaged, others = _state_cells(columns)
        interval = interval_text(share_of_successes(columns).interval)
        yield name, engaged, interval, others


def _state_cells(columns: Columns) -> tuple[str, str]:
    """Return the engaged runs, and the other states with their numbers."""
    states = {state: each.runs for state, each in states_in(columns).items()}
    engaged, runs = states.pop(ENGAGED, 0), len(columns['valid'])
    others = ', '.join(f'{count} {state_text(state)}' for state, count in states.items())
    return f'{engaged} of {runs}', others or '-'


def _figure_rows(rows: CaseRows) -> Iterator[tuple[str, ...]]:
    """Yield P50, P95 and worst of each controller's figures, a row each."""
    for name in rows.controllers:
        columns = rows.of(name)
        cells = []
        for key, form, factor in _FORMS:
            values = values_of(columns, key)
            assert values is not None
            cells.append(spread_texts(spread_in(columns, values), form, factor))
        for of, row in zip(('P50', 'P95', 'worst'), zip(*cells, strict=True), strict=True):
            yield name, of, *row


def _dominance(rows: CaseRows) -> Table:
    """Return how many controllers each one dominates, and which dominate it."""
    dominators = dominators_of(figures_in(rows))
    found = []
    for name in rows.controllers:
        dominated = sum(name in others for others in dominators.values())
        ours = dominators[name]
        found.append((name, str(dominated), str(len(ours)), ', '.join(ours[:3]) or '-'))
    headers = 'controller', 'dominates', 'dominated by', 'the first of these'
    return Table('Who dominates whom in all development cases', headers, found)


def _compared_cases(rows: CaseRows) -> str:
    """Return how many cases the dominance is of, and how many are left out of each figure."""
    figures = list(figures_in(rows).values())
    left_out = dict.fromkeys((each.name for each in FIGURES), 0)
    for place, ours in enumerate(figures):
        for theirs in figures[:place]:
            for found in compare(ours, theirs).figures:
                left_out[found.name] = max(left_out[found.name], found.null)
    return (
        f'dominance is of {rows.cases} cases, left out of a pair at most: '
        f'{texts.left_out_text(left_out)}'
    )
