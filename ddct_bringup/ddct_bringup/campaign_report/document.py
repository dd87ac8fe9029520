# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The document of a campaign: how often, where, by what and how badly engagements fail."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TypeVar

from ddct_bringup.campaign.keys import SCENARIO
from ddct_bringup.campaign_report import texts
from ddct_bringup.campaign_report.distributions_chart import distributions_chart, nothing_drawn
from ddct_bringup.campaign_report.maps import campaign_maps
from ddct_bringup.campaign_report.maps_figure import maps_drawing
from ddct_bringup.campaign_report.tables import (
    EFFECT_COLUMNS,
    MAIN,
    NO_VALUE,
    differences_table,
    effect_cells,
    interval_cell,
    meanings,
    outcomes_table,
    quantile_cells,
    quantity_cell,
    share_cell,
)
from ddct_bringup.documents.document import (
    Block,
    Cell,
    Column,
    Document,
    Figure,
    Note,
    Remarks,
    Row,
    Section,
    Table,
    Terms,
    given,
)
from ddct_bringup.documents.page_parts import value_text
from ddct_bringup.evaluation.boundaries import Boundary, BoundarySide
from ddct_bringup.evaluation.grouped_rows import GroupedRows
from ddct_bringup.evaluation.quantities import QUANTITIES
from ddct_bringup.evaluation.spread import QuantitySummary, RunValue
from ddct_bringup.evaluation.summary import GroupSummary, Summary
from ddct_bringup.verdict.state import ENGAGED
from ddct_plant.program.command_line import package_version
from ddct_plant.program.table import Weight

_NAME = Weight.IDENTIFYING
Entry = TypeVar('Entry')


@dataclass(frozen=True)
class PageParts:
    """What only the page of a campaign shows: charts of its rows, and its origin."""

    rows: GroupedRows
    facts: Mapping[str, str]
    """Origin as text by label."""


def campaign_document(summary: Summary, replay: str, page: PageParts | None = None) -> Document:
    """
    Return the document of a campaign.

    `replay` is the command that makes the bag of the run INDEX.
    """
    scenario = page.facts[SCENARIO] if page else ''
    return Document(
        'Campaign',
        f'Campaign, {scenario}' if scenario else 'Campaign',
        _lead(summary),
        given(
            _invalid(summary),
            Remarks(
                'Results of another version',
                list(texts.other_version_lines(summary.other_version)),
                alarming=True,
            ),
            Remarks('Before you read the tables', texts.notes_of(summary)),
            _often(summary),
            _first(summary, replay),
            _keys(summary),
            *(_charts(page, replay) if page else ()),
            _badly(summary, replay),
            _differences(summary),
            _origin(page.facts) if page else None,
        ),
        complete='campaign show --json FILE',
    )


def _lead(summary: Summary) -> str:
    several = len(summary.groups) > 1
    kind = 'group' if any(group.varied for group in summary.groups) else 'controller'
    found = [f'{summary.runs} runs of {len(summary.groups)} {kind}{"s" if several else ""}']
    if summary.grid:
        found.append(f'grid over {", ".join(summary.grid)}')
    if summary.random:
        found.append(f'random {", ".join(summary.random)}')
    return ' · '.join(found)


def _invalid(summary: Summary) -> Remarks:
    lines = [
        f'{group.label}, {found.runs} {"run" if found.runs == 1 else "runs"}, such as run '
        f'{found.index}: {found.reason}'
        for group in summary.groups
        for found in group.reasons
    ]
    verb = 'is' if summary.invalid == 1 else 'are'
    title = f'{summary.invalid} of {summary.runs} runs {verb} invalid'
    return Remarks(title, lines, alarming=True)


def _often(summary: Summary) -> Section:
    columns = [
        Column('controller', number=False, weight=_NAME),
        Column('failed', form='.1%', missing='every run is invalid'),
        Column('95 % interval', missing='the runs are no random sample'),
        Column('runs', form='d', weight=Weight.USEFUL),
        Column('engaged', form='d', weight=Weight.DETAIL),
        Column('failed', form='d', weight=Weight.USEFUL),
        Column('invalid', form='d', weight=Weight.USEFUL),
        Column('as', number=False),
    ]
    rows = [
        (
            group.label,
            share_cell(group.failed, bad=True),
            interval_cell(group.failed),
            group.runs,
            group.engaged.count,
            group.failed.count,
            Cell(group.invalid, alarming=group.invalid > 0),
            texts.states_text(group),
        )
        for group in summary.groups
    ]
    table = Table('', columns, rows, notes=[f'intervals: {summary.method.share_interval}'])
    return Section(
        'How often engagement fails',
        [table, texts.terms('failed', 'invalid', 'share', 'interval')],
        key='failed',
        short='How often',
    )


def _first(summary: Summary, replay: str) -> Section:
    columns = [
        Column('varied', number=False, weight=_NAME),
        Column('controller', number=False, weight=_NAME),
        Column('from', missing='the scenario gives no value, and 0 stands for it'),
        Column('first failure below', number=False),
        Column('first failure above', number=False),
        Column('others at', number=False),
    ]
    rows = [
        (
            found.key,
            group.label,
            _start(found),
            *(_side(side, replay) for side in (found.below, found.above)),
            ', '.join(f'{key} {value_text(at)}' for key, at in found.others.items()),
        )
        for group, found in _by_place(summary, lambda group: group.boundaries)
    ]
    if not rows:
        return Section('', [])
    return Section(
        'Where failure begins, along lines of the grid',
        [
            Table('', columns, rows),
            texts.terms('nominal', 'boundary'),
        ],
        key='first',
        short='Where failure begins',
    )


def _start(found: Boundary) -> Cell:
    nominal = '' if found.start == found.nominal else f'nominal {value_text(found.nominal)}'
    return Cell(found.start, '.6g', below=nominal)


def _side(side: BoundarySide, replay: str) -> Cell:
    hint = '' if side.index is None else replay.replace('INDEX', str(side.index))
    return Cell(texts.boundary_text(side), below=texts.good_text(side), hint=hint)


def _keys(summary: Summary) -> Section:
    causes = [(group.label, group.causes) for group in summary.groups if group.causes]
    rows = [(label, *effect_cells(found)) for label, each in causes for found in each.keys]
    columns = [Column('controller', number=False, weight=_NAME), *EFFECT_COLUMNS]
    if not rows:
        return Section('', [])
    return Section(
        'Which keys drive failure',
        [
            Note(
                'Runs that vary at random have no boundary of one key: what else was drawn '
                'differs from run to run. The table has what each key explains of failure by '
                'itself.',
                page_only=True,
            ),
            Table('', columns, rows),
            texts.terms('explained', 'drives', 'most failures'),
        ],
        key='keys',
        short='Which keys',
    )


def _badly(summary: Summary, replay: str) -> Section:
    further = [key for key in summary.groups[0].quantities if key not in MAIN]
    return Section(
        'How bad it becomes',
        given(
            _quantities(summary, MAIN, 'Engaged runs', replay),
            Section(
                'Further metrics',
                given(
                    _quantities(summary, further, 'Engaged runs, further metrics', replay),
                    meanings(further),
                ),
                folded=True,
            ),
            Note('The bag of a run:', replay.replace('INDEX', 'I')),
            texts.terms('quantiles', 'CVaR', 'worst'),
        ),
        key='badly',
        short='How badly',
    )


def _quantities(summary: Summary, keys: Sequence[str], what: str, replay: str) -> Table:
    columns = [
        Column('quantity', number=False, weight=_NAME, symbols=True),
        Column('controller', number=False, weight=_NAME),
        Column('n', form='d', weight=Weight.DETAIL),
        Column('P5', missing=NO_VALUE, weight=Weight.USEFUL),
        Column('P50', missing=NO_VALUE),
        Column('P95', missing=NO_VALUE),
        Column('CVaR', missing='too few engaged runs have a value', weight=Weight.USEFUL),
        Column('worst engaged', missing=NO_VALUE, weight=Weight.DETAIL),
        Column('run', form='d', missing=NO_VALUE, weight=Weight.DETAIL),
        Column('worst failed', missing='no failed run has more', weight=Weight.DETAIL),
        Column('run', missing='no failed run has more', weight=Weight.DETAIL),
    ]
    rows = [
        (quantity_cell(key), group.label, *_spread(group.quantities[key], key, replay))
        for key in keys
        for group in summary.groups
        if key in group.quantities
    ]
    return Table(f'{what}: quantiles with sign, CVaR and worst by magnitude', columns, rows)


def _spread(found: QuantitySummary, key: str, replay: str) -> Row:
    form = QUANTITIES[key].form
    failed = found.worst if found.worst and found.worst.state != ENGAGED else None
    return (
        found.with_value,
        *quantile_cells(found.quantiles, form),
        Cell(found.cvar_engaged, form),
        *_run_cells(found.worst_engaged, form, replay),
        *_run_cells(failed, form, replay),
    )


def _run_cells(found: RunValue | None, form: str, replay: str) -> tuple[Cell, Cell]:
    """Return a value and its run, with the command that makes its bag."""
    if found is None:
        return Cell(None), Cell(None)
    hint = replay.replace('INDEX', str(found.index))
    if found.state == ENGAGED:
        return Cell(found.value, form), Cell(found.index, hint=hint)
    run = f'{found.index} ({texts.state_text(found.state)})'
    return Cell(found.value, form), Cell(run, hint=hint, alarming=True)


def _differences(summary: Summary) -> Section:
    """Return the differences from the first controller, and folded all others."""
    if not summary.pairs:
        return Section('', [])
    of_first = summary.pairs_of(summary.pairs[0].first)
    others = [pair for pair in summary.pairs if pair not in of_first]
    further = [key for key in summary.pairs[0].differences if key not in MAIN]
    return Section(
        'Differences on the same cases, where both engaged',
        given(
            differences_table(of_first, MAIN),
            outcomes_table(of_first, 'Cases of these differences'),
            Section(
                'Between the other controllers',
                given(
                    differences_table(others, MAIN),
                    outcomes_table(others, 'Cases of the differences between the others'),
                ),
                folded=True,
            ),
            Section(
                'Differences in further metrics',
                given(differences_table(summary.pairs, further)),
                folded=True,
            ),
            texts.terms('difference', 'difference interval'),
        ),
        key='pairs',
        short='Differences',
    )


def _charts(page: PageParts, replay: str) -> Iterator[Section]:
    why = nothing_drawn(page.rows)
    yield Section(
        'Distributions', [Note(f'Nothing to draw: {why}.')] if why else _curves(page), key='spread'
    )
    maps = campaign_maps(page.rows)
    why = 'No run has a value' if page.rows.numbers else 'No number was varied'
    drawn: Block = Note(f'{why}, so there is no map.')
    if maps:
        words = 'Maps of each controller over two varied numbers, on the page of the campaign'
        drawn = Figure('', partial(maps_drawing, maps, replay), words)
    yield Section('Maps', [drawn], key='maps')


def _curves(page: PageParts) -> list[Block]:
    return [
        Note(
            'Each curve is the share of the valid runs that engaged with at most this value. '
            'It ends at the share of the runs that engaged and have a value.'
        ),
        Figure(
            '',
            partial(distributions_chart, page.rows, page.facts[SCENARIO]),
            'Distributions of the main metrics by controller; the table below has P5, P50 and P95',
        ),
    ]


def _origin(facts: Mapping[str, str]) -> Section:
    return Section(
        'Origin',
        [Terms({**facts, 'page made with': f'ddct_bringup {package_version()}'}, facts=True)],
        key='origin',
    )


def _by_place(
    summary: Summary, entries_of: Callable[[GroupSummary], Sequence[Entry]]
) -> Iterator[tuple[GroupSummary, Entry]]:
    """Yield the entries of all groups: the first of each, then the second of each."""
    for of_place in zip(*map(entries_of, summary.groups), strict=True):
        yield from zip(summary.groups, of_place, strict=True)
