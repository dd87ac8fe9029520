# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page on real time shows the record of `make soak`."""

from typing import Any

import pytest
from generator.pages import DOCS, as_markdown, shown_tables
from generator.speed.soak_tables import (
    RECORD,
    digest_of_record,
    record_of,
    soak_figure,
    soak_tables,
)
from generator.speed.speed_charts import DRAWN_FROM
from PIL import Image
from soak.__main__ import RECORD as WRITTEN

AGAIN = 'run: make docs KINDS=soak'
COUNTS = {'lateness': {80: 98, 160: 2}, 'jitter': {16: 99}, 'latency': {160: 98, 220: 2}}
Record = dict[str, Any]


def side(missed: int) -> Record:
    durations = {
        name: {'largest_us': 14000.0, 'counts': {str(place): n for place, n in counts.items()}}
        for name, counts in COUNTS.items()
    }
    return {'steps': 100, 'missed_steps': missed, 'durations': durations}


@pytest.fixture
def record() -> Record:
    return {
        'machine': {
            **{'processor': 'X', 'cores': 2, 'python': '3.11', 'packages': {'rclpy': '7.1.5'}},
            'kernel': '6.1 PREEMPT_RT',
        },
        'measured': [
            {
                **{'condition': 'idle', 'what': 'nothing else', 'load_before': 0.5},
                **{'other_cores': 0.25, 'stolen_cores': 0.001},
                **{'time': '2026-01-01T00:00Z', 'commit': '0123456789', 'changed': False},
                'sides': {'graph': side(1), 'chain': side(2)},
                'nodes': {
                    'driveline': {'core_share': 0.125, 'memory_mb': 80.2, 'growth_mb': 0.04}
                },
            }
        ],
    }


def test_the_tables_have_percentiles_of_both_sides_in_ms(record: Record) -> None:
    rows = soak_tables(record)['durations'].rows
    assert [row[:3] for row in rows[::3]] == [
        ('nothing else', 'the graph', '1 of 100'),
        ('nothing else', 'the bare chain', '2 of 100'),
    ]
    assert rows[0][3:] == ('latency in ms', '1.07', '14.00', '14.00', '14.00')


def test_the_tables_have_the_machine_and_what_each_process_used(record: Record) -> None:
    tables = soak_tables(record)
    assert ('kernel', '6.1 PREEMPT_RT') in tables['machine'].rows
    assert 'commit 0123456789; load 0.5' in tables['machine'].rows[-1][1]
    assert tables['nodes'].rows == [['driveline', '12.5', '80', '0.0']]


def test_the_chart_has_the_share_of_longer_latencies(record: Record) -> None:
    (panel,) = soak_figure(record).axes
    graph, chain, _ = panel.lines
    assert graph.get_ydata() == pytest.approx([0.02])
    assert graph.get_xdata() == pytest.approx([1.069], rel=1e-3)
    assert chain.get_xdata() == pytest.approx([1.069], rel=1e-3)


def test_the_page_shows_the_record_of_the_soak() -> None:
    assert RECORD == WRITTEN
    assert shown_tables('soak') == as_markdown(soak_tables(record_of())), AGAIN
    with Image.open(DOCS / 'images' / 'real_time.png') as image:
        assert image.info[DRAWN_FROM] == digest_of_record(), AGAIN
