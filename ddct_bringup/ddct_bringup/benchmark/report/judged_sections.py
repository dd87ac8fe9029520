# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What a benchmark says of one judged controller, in development cases beside held-out ones."""

import shlex
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from ddct_bringup.benchmark.report import texts
from ddct_bringup.benchmark.result_types import JudgedResult, Result
from ddct_bringup.campaign_report.tables import (
    EFFECT_COLUMNS,
    difference_interval,
    effect_cells,
    interval_cell,
    meanings,
    quantity_cell,
    share_cell,
)
from ddct_bringup.campaign_report.texts import joint_outcomes_text, p_text
from ddct_bringup.documents.document import (
    Block,
    Cell,
    Column,
    Note,
    Row,
    Section,
    Table,
    given,
)
from ddct_bringup.evaluation.held_out_gaps import Gap
from ddct_bringup.evaluation.quantities import MAIN, QUANTITIES
from ddct_bringup.evaluation.spread import QuantitySummary
from ddct_bringup.evaluation.summary import GroupSummary, PairSummary, Summary
from ddct_plant.program.table import Weight

_NAME = Weight.IDENTIFYING
_STATES_OF = {'development': Weight.DETAIL, 'held out': Weight.NEEDED}
"""How much the states other than engaged matter, by set of cases."""
_SETS = tuple(_STATES_OF)
_TOO_FEW = 'too few runs have a value'
_QUANTITY = Column('quantity', number=False, weight=_NAME, symbols=True)
_CONTROLLER = Column('controller', number=False, weight=_NAME)


@dataclass(frozen=True)
class _Judged:
    """A judged controller with the two summaries that stand side by side."""

    name: str
    development: Summary
    held_out: Summary
    sides: tuple[tuple[GroupSummary, GroupSummary], ...]
    """The judged controller, then those beside it: in development and held-out cases."""


def judged_sections(result: Result, judged: JudgedResult) -> Iterator[Section]:
    """Yield the sections of one judged controller."""
    if not result.development or not judged.held_out:
        return
    sides = result.side_by_side(judged)
    of = _Judged(judged.controller, result.development, judged.held_out, sides)
    name = of.name
    prefix = f'{name}: ' if len(result.judged) > 1 else ''
    further = _further(of)
    yield Section(
        f'How often {name} succeeds',
        given(
            _often(of),
            gaps_table(judged.gaps or (), f'figure of {name}'),
            Section('By scenario', [_successes_by_scenario(of)], page_only=True),
            texts.terms('development', 'held out', 'success', 'interval', 'gap'),
        ),
        key=f'{name}-often',
        short=f'{prefix}How often',
    )
    replay = ('ddct', 'campaign', 'replay', f'{name}/held_out', '--index', 'CASE')
    yield Section(
        f'How well {name} engages',
        given(
            _spreads(of, MAIN),
            Section('Figures by scenario', [_spreads_by_scenario(of)], folded=True),
            Section(
                'Further metrics', given(_spreads(of, further), meanings(further)), folded=True
            ),
            Note(
                f'The bag of a case of {name}, in the folder of this page:',
                shlex.join([*replay, '--out', '../again']),
                page_only=True,
            ),
            texts.terms('P50, P95, worst'),
        ),
        key=f'{name}-well',
        short=f'{prefix}How well',
    )
    if lines := list(texts.dominance_lines(of.development, name)):
        yield Section(
            'Who dominates whom',
            [
                *(Note(line) for line in lines),
                Section(
                    f'Development cases in which {name} is better and worse than each',
                    [_dominance(of)],
                    folded=True,
                ),
                texts.terms('better, worse', 'dominates'),
            ],
            key=f'{name}-dominance',
            short=f'{prefix}Dominance',
        )
    yield Section(
        f'Which keys drive failure of {name}',
        list(_causes(of)),
        key=f'{name}-keys',
        short=f'{prefix}Which keys',
        page_only=True,
    )
    yield Section(
        'Differences on the same cases',
        given(
            *(
                Note(f'{pair.label}, held out: both engaged in {joint_outcomes_text(pair)}')
                for pair in of.held_out.pairs_of(name)
            ),
            _differences(of, MAIN),
            Section(
                'Differences in further metrics', given(_differences(of, further)), folded=True
            ),
            texts.terms('difference', 'difference interval'),
        ),
        key=f'{name}-pairs',
        short=f'{prefix}Differences',
        page_only=True,
    )


def _further(of: _Judged) -> list[str]:
    """Return the quantities besides the figures that a run of the judged controller has."""
    there = {
        key for side in of.sides[0] for key, found in side.quantities.items() if found.with_value
    }
    return [key for key in QUANTITIES if key in there and key not in MAIN]


def _often(of: _Judged) -> Table:
    columns = [_CONTROLLER]
    for group in _SETS:
        columns += [
            Column('success', form='.1%', group=group),
            Column('95 % interval', group=group),
            Column('other states', number=False, weight=_STATES_OF[group], group=group),
        ]
    rows = [
        (
            ours.controller,
            *(
                cell
                for each in (ours, theirs)
                for cell in (
                    share_cell(each.engaged),
                    interval_cell(each.engaged),
                    texts.states_text(each),
                )
            ),
        )
        for ours, theirs in of.sides
    ]
    return Table('', columns, rows, emphasised=[0])


def gaps_table(gaps: Sequence[Gap], title: str) -> Table:
    """Return the gaps of the five figures; `title` says of what they are."""
    columns = [
        Column(title, number=False, weight=_NAME, symbols=True),
        Column('a held-out run is the worse one', form='.1%', missing=_TOO_FEW),
        Column('p', missing=_TOO_FEW),
        Column('left out', form='d', weight=Weight.DETAIL),
        Column('beyond chance', number=False),
    ]
    rows = [
        (
            texts.figure_name(gap.name),
            gap.worse,
            None if gap.p_value is None else p_text(gap.p_value),
            gap.left_out,
            Cell('yes' if gap.differs else 'no', alarming=gap.differs),
        )
        for gap in gaps
    ]
    return Table('Development beside held out', columns, rows)


def _successes_by_scenario(of: _Judged) -> Table:
    development, held_out = of.sides[0]
    columns = [
        Column('scenario', number=False, weight=_NAME),
        Column(of.name, group='development'),
        *(Column(each.controller, group='held out') for _, each in of.sides),
    ]
    rows = [
        (
            scenario,
            *(
                f'{part.count} of {part.of}'
                for group in (development, *(each for _, each in of.sides))
                for part in [group.parts[scenario].engaged]
            ),
        )
        for scenario in held_out.parts
    ]
    return Table('', columns, rows)


def _spread_columns() -> list[Column]:
    columns = []
    for group in _SETS:
        missing = texts.NO_VALUE
        columns += [
            Column('n', form='d', weight=Weight.DETAIL, group=group),
            Column('P50', missing=missing, group=group),
            Column('P95', missing=missing, group=group),
            Column('worst', missing=missing, group=group),
            Column('case', form='d', missing=missing, weight=Weight.DETAIL, group=group),
        ]
    return columns


def spread_cells(quantities: Mapping[str, QuantitySummary], key: str) -> Row:
    """Return the number of successes with a value, P50, P95 and worst, and the worst's case."""
    found, form = quantities.get(key), QUANTITIES[key].form
    if found is None or found.worst_engaged is None:
        return (0, None, None, None, None)
    quantiles, worst = found.quantiles, found.worst_engaged
    values = (quantiles.p50, quantiles.p95, worst.value)
    return (found.with_value, *(Cell(value, form) for value in values), worst.index)


def _spreads(of: _Judged, keys: Sequence[str]) -> Table:
    rows = [
        (
            quantity_cell(key),
            theirs.controller,
            *spread_cells(ours.quantities, key),
            *spread_cells(theirs.quantities, key),
        )
        for key in keys
        for ours, theirs in of.sides
    ]
    emphasised = range(0, len(rows), len(of.sides))
    return Table('', [_QUANTITY, _CONTROLLER, *_spread_columns()], rows, emphasised)


def _spreads_by_scenario(of: _Judged) -> Table:
    ours, theirs = of.sides[0]
    scenario_column = Column('scenario', number=False, weight=_NAME)
    rows = [
        (
            quantity_cell(key),
            scenario,
            *spread_cells(ours.parts[scenario].quantities, key),
            *spread_cells(theirs.parts[scenario].quantities, key),
        )
        for key in MAIN
        for scenario in theirs.parts
    ]
    return Table('', [_QUANTITY, scenario_column, *_spread_columns()], rows)


def _dominance(of: _Judged) -> Table:
    columns = [_CONTROLLER, Column('dominance', number=False)]
    for key in MAIN:
        symbol = QUANTITIES[key].symbol
        columns += [
            Column(name, form='d', group=symbol) for name in ('better', 'worse', 'left out')
        ]
    ours = of.development.group(of.name)
    rows = []
    for pair in of.development.pairs_of(of.name):
        if not pair.comparison:
            continue
        other = of.development.group(pair.second)
        word = 'dominates' if pair.second in (ours.dominated_by or ()) else ''
        if of.name in (other.dominated_by or ()):
            word = 'dominated'
        counts = [
            count
            for key in MAIN
            for found in [pair.comparison.figures[key]]
            for count in (found.better, found.worse, found.left_out)
        ]
        rows.append((pair.second, word, *counts))
    return Table('', columns, rows)


def _causes(of: _Judged) -> Iterator[Block]:
    """Yield the table of each set, or why it has none, and the definitions where one has."""
    tables = 0
    for title, group in zip(_SETS, of.sides[0], strict=True):
        causes = group.causes
        if causes is None:
            continue
        if causes.too_few:
            yield Note(f'{title}: {causes.too_few}.')
        elif causes.keys:
            tables += 1
            yield Table(title, EFFECT_COLUMNS, [effect_cells(each) for each in causes.keys])
    if tables:
        yield texts.terms('explained', 'drives', 'most failures')


def _differences(of: _Judged, keys: Sequence[str]) -> Table:
    columns = [_QUANTITY, Column('controllers', number=False, weight=_NAME)]
    for group in _SETS:
        missing = 'both engaged in too few cases'
        columns += [
            Column('cases', form='d', group=group),
            Column('P50', missing=missing, group=group),
            Column('95 % interval of P50', missing=missing, group=group),
        ]
    rows = [
        (
            quantity_cell(key),
            pair.label,
            *_difference_cells(of.development.pair(of.name, pair.second), key),
            *_difference_cells(pair, key),
        )
        for key in keys
        for pair in of.held_out.pairs_of(of.name)
    ]
    return Table('', columns, rows)


def _difference_cells(pair: PairSummary, key: str) -> Row:
    form = QUANTITIES[key].form
    found = pair.differences.get(key)
    if found is None:
        return (0, None, None)
    return (found.cases, Cell(found.quantiles.p50, form), difference_interval(found, form))
