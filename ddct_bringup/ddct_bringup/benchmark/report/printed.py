# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Tables of a benchmark for the terminal."""

from collections.abc import Iterator

from ddct_bringup.benchmark.report import texts
from ddct_bringup.benchmark.result_types import Evaluation, JudgedResult, Result, RunShare
from ddct_bringup.benchmark.update_times import UpdateTimesFile
from ddct_bringup.campaign_report.printed_summary import MAIN
from ddct_bringup.campaign_report.texts import interval_text, p_text, share_text
from ddct_bringup.metrics.catalogue import METRICS
from ddct_plant.program.printed_table import print_note, print_tables
from ddct_plant.program.table import UNDEFINED, Table, Weight, text_or_dash, with_reasons

_NO_QUANTITY = {
    **dict.fromkeys(('development', 'held out'), 'no engaged run has a value'),
    '/least': 'the quantity has no least value',
}
"""Reasons of dashes by header."""
_TITLES = 'development', '95 % interval', 'held out', '95 % interval'


def print_result(result: Result, update_times: UpdateTimesFile) -> None:
    """Print the main tables of a benchmark; the page has all."""
    for judged in result['controllers']:
        if judged['development'] and judged['held_out']:
            print_tables(_tables(judged, judged['development'], judged['held_out']))
    for name, found in update_times['controllers'].items():
        ratio = text_or_dash(found['ratio_to_pi'], '.2f')
        print_note(f'update time of {name} over that of pi: {ratio}')
    best = [row['controller'] for row in result['board'] if row['non_dominated']]
    print_note(f'not dominated on the development cases: {", ".join(best)}')


def _tables(
    judged: JudgedResult, ours: list[Evaluation], theirs: list[Evaluation]
) -> Iterator[Table]:
    both = [*zip(ours, theirs, strict=True)]
    name = judged['controller']
    rows = [
        (first['controller'], *_share_cells(first['success']), *_share_cells(second['success']))
        for first, second in both
    ]
    yield Table(f'{name}: successful engagements', ('controller', *_TITLES), rows)
    over_least = Table(
        f'{name}: P95 of engaged runs, and over the least',
        ('quantity', 'controller', 'development', '/least', 'held out', '/least'),
        [
            (METRICS[key].heading, first['controller'], *_p95(first, key), *_p95(second, key))
            for key in MAIN
            for first, second in both
        ],
        weights=(Weight.IDENTIFYING, Weight.IDENTIFYING),
    )
    yield with_reasons(over_least, lambda header, row: _NO_QUANTITY[header])
    kept = [
        (first['controller'], _limit_text(first), _limit_text(second)) for first, second in both
    ]
    yield Table(f'{name}: avoidable limits kept', ('controller', *_TITLES[::2]), kept)
    gaps = Table(
        f'{name}: development beside held out',
        ('figure', 'a held-out run is worse', 'p', 'beyond chance'),
        [
            (
                texts.gap_name(gap['name']),
                share_text(gap['worse']),
                UNDEFINED if gap['p_value'] is None else p_text(gap['p_value']),
                'yes' if gap['differs'] else 'no',
            )
            for gap in judged['gaps'] or ()
        ],
    )
    yield with_reasons(gaps, lambda header, row: 'too few runs have a value')


def _share_cells(share: RunShare) -> tuple[str, str]:
    return share_text(share['share']), interval_text(share['interval'])


def _limit_text(evaluation: Evaluation) -> str:
    found = evaluation['limits']
    return f'{share_text(found["share"])} of {found["avoidable"]}'


def _p95(evaluation: Evaluation, key: str) -> tuple[str, str]:
    """Return P95 of a quantity and of its ratio to the least."""
    for found in evaluation['quantities']:
        if found['name'] == key:
            over = found['over_floor']
            ratio = text_or_dash(over['p95'] if over else None, '.2f')
            return text_or_dash(found['p95'], METRICS[key].form), ratio
    return UNDEFINED, UNDEFINED
