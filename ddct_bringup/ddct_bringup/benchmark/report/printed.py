# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of a benchmark for the terminal."""

from collections.abc import Iterator, Sequence

from ddct_bringup.benchmark.report import texts
from ddct_bringup.benchmark.report.rules import left_open_here
from ddct_bringup.benchmark.result_types import JudgedResult, Result
from ddct_bringup.benchmark.update_times import UpdateTimesFile
from ddct_bringup.campaign_report.texts import p_text
from ddct_bringup.evaluation.quantities import MAIN, QUANTITIES
from ddct_bringup.evaluation.share import share_text
from ddct_bringup.evaluation.spread import QuantitySummary
from ddct_bringup.evaluation.summary import GroupSummary
from ddct_plant.program.printed_table import print_note, print_tables
from ddct_plant.program.table import UNDEFINED, Table, Weight, text_or_dash, with_reasons

_SHARES = 'development', '95 % interval', 'held out', '95 % interval'
_OF_SPREAD = 'P50', 'P95', 'worst'


def print_result(result: Result, update_times: UpdateTimesFile) -> None:
    """Print the main tables of a benchmark; the page has all."""
    for judged in result.judged:
        if judged.held_out and result.development:
            theirs = judged.held_out.groups
            ours = [result.development.group(each.controller) for each in theirs]
            print_tables(_tables(judged, ours, theirs))
            for line in texts.dominance_lines(result.development, judged.controller):
                print_note(line)
    for name, found in update_times.controllers.items():
        ratio = text_or_dash(found.update_time_over_pi, '.2f')
        print_note(f'update time of {name} over that of pi: {ratio}')
    print_note(left_open_here())


def _tables(
    judged: JudgedResult, ours: Sequence[GroupSummary], theirs: Sequence[GroupSummary]
) -> Iterator[Table]:
    name = judged.controller
    rows = [
        (
            first.controller,
            *(cell for each in (first, second) for cell in _share_cells(each)),
        )
        for first, second in zip(ours, theirs, strict=True)
    ]
    yield Table(f'{name}: engaged', ('controller', *_SHARES), rows)
    for part, groups in (('development', ours), ('held out', theirs)):
        spreads = Table(
            f'{name}: successes, {part}',
            ('figure', 'controller', *_OF_SPREAD, 'worst case'),
            [
                (QUANTITIES[key].heading, each.controller, *spread_cells(each, key))
                for key in MAIN
                for each in groups
            ],
            numbers=(False, False, True, True, True, True),
            weights=(Weight.IDENTIFYING, Weight.IDENTIFYING),
        )
        yield with_reasons(spreads, lambda header, row: texts.NO_VALUE)
    gaps = Table(
        f'{name}: development beside held out',
        ('figure', 'a held-out run is worse', 'p', 'beyond chance'),
        [
            (
                texts.figure_name(gap.name),
                share_text(gap.worse),
                UNDEFINED if gap.p_value is None else p_text(gap.p_value),
                'yes' if gap.differs else 'no',
            )
            for gap in judged.gaps or ()
        ],
    )
    yield with_reasons(gaps, lambda header, row: 'too few runs have a value')


def _share_cells(group: GroupSummary) -> tuple[str, str]:
    return group.engaged.text, group.engaged.interval_text


def spread_cells(group: GroupSummary, key: str) -> tuple[str, ...]:
    """Return P50, P95 and worst of a quantity, and the case of the worst."""
    found = group.quantities.get(key)
    worst = found.worst_engaged if found else None
    cells = spread_texts(found, QUANTITIES[key].form)
    return *cells, str(worst.index) if worst else UNDEFINED


def spread_texts(
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
