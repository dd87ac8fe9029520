# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The table of a bench fits 80 columns and names each reference, outcome and reason."""

import io

from bench.skeleton.output import Progress, table_of, text_of
from bench.skeleton.rounds import Result

LONG = 'a figure with a name that is much too long for a line of the table of the bench'


def test_the_table_groups_figures_by_reference_and_shows_spread_bound_and_outcome() -> None:
    shown = table_of(
        [
            Result('graph', 'the chain', (1.4, 1.2, 1.3), 1.5),
            Result('page', 'a bare page', reason='no browser'),
            Result('update', 'DAQP', (6.4, 6.1, 6.6)),
            Result('step', 'the chain', (2.0, 1.6), 1.5),
            Result('broken', 'the chain', reason='KeyError: 1', failed=True),
        ]
    )
    assert shown.splitlines() == [
        'Beside the chain                             ratio         rounds bound',
        '  graph                                       1.30      1.20-1.40  1.50  met',
        '  step                                        1.80      1.60-2.00  1.50  MISSED',
        '',
        'Beside DAQP                                  ratio         rounds bound',
        '  update                                      6.40      6.10-6.60',
        '',
        'Not measured: no browser',
        '  page, beside a bare page',
        '',
        'Failed: KeyError: 1',
        '  broken, beside the chain',
        '',
        'Beyond its bound in every round, or failed: step; broken.',
    ]


def test_no_line_is_wider_than_80_columns() -> None:
    results = [
        Result(LONG, LONG, (123456.0, 0.000123), 1234.5),
        Result(LONG, 'b', (1234.5, 1234.5), 0.01),
        Result(LONG, LONG, reason=f'{LONG} {LONG}'),
    ]
    assert max(map(len, table_of(results).splitlines())) <= 80


def test_a_ratio_has_three_digits_and_two_below_a_tenth() -> None:
    texts = [text_of(ratio) for ratio in (0.00642, 0.0768, 0.47, 1.0, 18.64, 123.4)]
    assert texts == ['0.0064', '0.077', '0.470', '1.00', '18.6', '123']


def test_progress_in_a_file_is_a_line_for_each_result() -> None:
    stream = io.StringIO()
    progress = Progress(2, 3, stream)
    progress.during(1, 'graph', 0)
    progress.after(1, [Result('graph', 'the chain', (1.4,)), Result('page', 'b', reason='none')])
    lines = stream.getvalue().splitlines()
    assert [line.partition(' s  ')[2] for line in lines] == ['graph: 1.40', 'page: not measured']
