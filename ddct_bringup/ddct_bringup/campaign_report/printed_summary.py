# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of a campaign for the terminal."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

from ddct_bringup.campaign_report import texts
from ddct_bringup.evaluation.quantities import QUANTITIES
from ddct_bringup.evaluation.spread import Quantiles, QuantitySummary, RunValue
from ddct_bringup.evaluation.summary import GroupSummary, Summary
from ddct_bringup.metrics.catalogue import FIGURES, TABLE_5_1
from ddct_plant.program.printed_table import print_note, print_tables
from ddct_plant.program.table import UNDEFINED, Table, Weight, text_or_dash, with_reasons

_OF_TWO = (Weight.IDENTIFYING, Weight.IDENTIFYING)
"""Weights of a table whose first two columns identify a row."""
Entry = TypeVar('Entry')
MAIN = tuple(each.key for each in (*FIGURES, *TABLE_5_1))
"""Figures and metrics of Table 5.1, whose differences are shown where the runs have them."""


def summary_tables(summary: Summary) -> list[Table]:
    """Return the tables of failed runs, boundaries or causes, quantities, and differences."""
    tables = (
        _failed(summary),
        *_boundaries(summary),
        *_attribution(summary),
        _quantities(summary),
        *_differences(summary),
    )
    return [replace(with_reasons(table, _dash_reason), complete='--json FILE') for table in tables]


def _dash_reason(header: str, row: Sequence[str]) -> str:
    """Return the reason of a dash by its column."""
    return {
        'failed': 'every run is invalid',
        '95 % interval': 'the cases are no random sample',
        'as': 'no run failed',
        'others at': 'no other key is varied',
        'most failures': 'the key has no evidence',
        '95 % interval of P50': 'too few cases',
    }.get(header, 'no engaged run has a value')


def print_summary(summary: Summary, folder: Path) -> None:
    """Print the summary of the campaign in a folder."""
    print_tables(summary_tables(summary))
    for note in texts.notes_of(summary):
        print_note(note)
    print(f'the bag of a run: {texts.replay_command(str(folder), "I")}')


def _failed(summary: Summary) -> Table:
    rows = [
        (
            group.label,
            group.failed.text,
            group.failed.interval_text,
            *map(str, (group.runs, group.engaged.count, group.failed.count, group.invalid)),
            texts.states_text(group) or UNDEFINED,
        )
        for group in summary.groups
    ]
    method = summary.method.share_interval
    headers = 'controller', 'failed', '95 % interval', 'runs', 'engaged', 'failed', 'invalid', 'as'
    title = f'How often engagement fails (intervals: {method})'
    weights = (
        *(Weight.IDENTIFYING, Weight.NEEDED, Weight.NEEDED, Weight.USEFUL),
        *(Weight.DETAIL, Weight.USEFUL, Weight.USEFUL, Weight.NEEDED),
    )
    return Table(title, headers, rows, numbers=[False, *[True] * 6], weights=weights)


def _boundaries(summary: Summary) -> Iterator[Table]:
    rows = [
        (
            found.key,
            group.label,
            texts.value_text(found.start),
            *(
                text(side)
                for side in (found.below, found.above)
                for text in (texts.good_text, texts.boundary_text)
            ),
            ', '.join(f'{key} {texts.value_text(at)}' for key, at in found.others.items())
            or UNDEFINED,
        )
        for group, found in _by_place(summary, lambda group: group.boundaries)
    ]
    headers = 'varied', 'controller', 'from', 'below', 'fails at', 'above', 'fails at', 'others at'
    if rows:
        yield Table(
            'Where failure begins, along lines of the grid', headers, rows, weights=_OF_TWO
        )


def _attribution(summary: Summary) -> Iterator[Table]:
    rows = [
        (
            group.label,
            each.key,
            'yes' if each.drives else 'no evidence',
            f'{each.explained:.2f}',
            '{:.2f} to {:.2f}'.format(*each.interval),
            texts.p_text(each.p_value),
            texts.part_text(each.worst_part) if each.drives else UNDEFINED,
        )
        for group in summary.groups
        if group.causes
        for each in group.causes.keys
    ]
    headers = (
        *('controller', 'key', 'drives failure', 'explains', '95 % interval', 'p'),
        'most failures',
    )
    if rows:
        yield Table('Which keys drive failure', headers, rows, weights=_OF_TWO)


def _by_place(
    summary: Summary, entries_of: Callable[[GroupSummary], Sequence[Entry]]
) -> Iterator[tuple[GroupSummary, Entry]]:
    """Yield the entries of all groups: the first of each, then the second of each."""
    for of_place in zip(*map(entries_of, summary.groups), strict=True):
        yield from zip(summary.groups, of_place, strict=True)


def _quantities(summary: Summary) -> Table:
    """Return the table of the figures and metrics that a run has."""
    rows = [
        _quantity(group.label, name, found)
        for group, (name, found) in _by_place(summary, lambda group: [*group.quantities.items()])
    ]
    headers = (
        *('quantity', 'controller', 'n', 'P5', 'P50', 'P95', 'CVaR', 'worst engaged', 'run'),
        *('worst', 'run'),
    )
    title = 'Engaged runs: quantiles with sign, CVaR and worst by magnitude'
    weights = (
        *(*_OF_TWO, Weight.DETAIL, Weight.USEFUL, Weight.NEEDED, Weight.NEEDED, Weight.USEFUL),
        *[Weight.DETAIL] * 4,
    )
    return Table(title, headers, rows, numbers=[False, False, *[True] * 9], weights=weights)


def _quantile_cells(found: Quantiles, form: str) -> Iterator[str]:
    return (text_or_dash(value, form) for value in (found.p5, found.p50, found.p95))


def _quantity(label: str, name: str, found: QuantitySummary) -> Sequence[str]:
    quantity = QUANTITIES[name]
    engaged, worst = found.worst_engaged, found.worst
    return (
        quantity.heading,
        label,
        str(found.with_value),
        *_quantile_cells(found.quantiles, quantity.form),
        text_or_dash(found.cvar_engaged, quantity.form),
        _value(engaged, quantity.form),
        str(engaged.index) if engaged else UNDEFINED,
        _value(worst, quantity.form),
        f'{worst.index} ({texts.state_text(worst.state)})' if worst else UNDEFINED,
    )


def _value(found: RunValue | None, form: str) -> str:
    return UNDEFINED if found is None else f'{found.value:{form}}'


def _differences(summary: Summary) -> Iterator[Table]:
    """Yield the differences of the other controllers from the first in the main metrics."""
    if not summary.pairs:
        return
    first = summary.pairs[0].first
    pairs = [pair for pair in summary.pairs if pair.first == first]
    rows = [
        (
            QUANTITIES[name].heading,
            pair.label,
            str(found.cases),
            *_quantile_cells(found.quantiles, form),
            UNDEFINED
            if found.interval is None
            else ' to '.join(f'{end:{form}}' for end in found.interval),
        )
        for name in MAIN
        for pair in pairs
        if name in pair.differences
        for found, form in [(pair.differences[name], QUANTITIES[name].form)]
    ]
    headers = 'quantity', 'controllers', 'cases', 'P5', 'P50', 'P95', '95 % interval of P50'
    title = 'Differences on the same cases, where both engaged (interval: sign test)'
    weights = (*_OF_TWO, Weight.USEFUL)
    yield Table(title, headers, rows, numbers=[False, False, *[True] * 4], weights=weights)
    both = [(pair.label, texts.joint_outcomes_text(pair)) for pair in pairs]
    yield Table('Cases of these differences', ('controllers', 'both engaged'), both)
