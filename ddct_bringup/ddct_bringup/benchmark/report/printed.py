# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of a benchmark for the terminal."""

from collections.abc import Iterator

from ddct_bringup.benchmark.evaluated import EVALUATED, MAIN
from ddct_bringup.benchmark.report import texts
from ddct_bringup.benchmark.report.rules import left_open_here
from ddct_bringup.benchmark.result_types import (
    Evaluation,
    JudgedResult,
    Result,
    RunShare,
    ValueSpread,
)
from ddct_bringup.benchmark.update_times import UpdateTimesFile
from ddct_bringup.campaign_report.texts import interval_text, p_text, share_text
from ddct_plant.program.printed_table import print_note, print_tables
from ddct_plant.program.table import UNDEFINED, Table, Weight, text_or_dash, with_reasons

_SHARES = 'development', '95 % interval', 'held out', '95 % interval'
_OF_SPREAD = 'P50', 'P95', 'worst'


def print_result(result: Result, update_times: UpdateTimesFile) -> None:
    """Print the main tables of a benchmark; the page has all."""
    for judged in result.controllers:
        if judged.development and judged.held_out:
            print_tables(_tables(judged, judged.development, judged.held_out))
        for line in texts.dominance_lines(judged):
            print_note(line)
    for name, found in update_times.controllers.items():
        ratio = text_or_dash(found.update_time_over_pi, '.2f')
        print_note(f'update time of {name} over that of pi: {ratio}')
    print_note(left_open_here())


def _tables(
    judged: JudgedResult, ours: list[Evaluation], theirs: list[Evaluation]
) -> Iterator[Table]:
    name = judged.controller
    rows = [
        (first.controller, *_share_cells(first.success), *_share_cells(second.success))
        for first, second in zip(ours, theirs, strict=True)
    ]
    yield Table(f'{name}: engaged', ('controller', *_SHARES), rows)
    for part, evaluations in (('development', ours), ('held out', theirs)):
        spreads = Table(
            f'{name}: successes, {part}',
            ('figure', 'controller', *_OF_SPREAD, 'worst case'),
            [
                (EVALUATED[key].heading, each.controller, *_spread_cells(each, key))
                for key in MAIN
                for each in evaluations
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


def _share_cells(share: RunShare) -> tuple[str, str]:
    return share_text(share.share), interval_text(share.interval)


def _spread_cells(evaluation: Evaluation, key: str) -> tuple[str, ...]:
    """Return P50, P95 and worst of a quantity, and the case of the worst."""
    for found in evaluation.quantities:
        if found.name == key:
            cells = spread_texts(found.spread, EVALUATED[key].form)
            return *cells, text_or_dash(found.spread.worst.case, 'd')
    return (UNDEFINED,) * 4


def spread_texts(found: ValueSpread, form: str, factor: float = 1.0) -> tuple[str, str, str]:
    """Return P50, P95 and worst, times a factor."""
    values = found.quantiles.p50, found.quantiles.p95, found.worst.value
    p50, p95, worst = (
        UNDEFINED if value is None else f'{factor * value:{form}}' for value in values
    )
    return p50, p95, worst
