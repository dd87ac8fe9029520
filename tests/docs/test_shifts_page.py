# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rows and picture of the page of gear shifts are what the runs give."""

import pytest
from generator.drawings.study_charts import curves_of, drawn_curves
from generator.pages import DOCS, rows_of, shown_tables
from generator.runs.shift_tables import (
    CHART,
    SCENARIO,
    SOME,
    phases_chart,
    shift_row,
    shift_scenarios,
)

from ddct_controllers.design.drawing.chart_style import chart_style
from ddct_controllers.handover.laws import HANDOVERS
from ddct_controllers.registry import own_controller_names

SHOWN = {name: rows_of(text) for name, text in shown_tables('shifts').items()}
MAKE = 'run: make docs KINDS=shifts'


def test_the_page_has_a_row_of_every_controller_handover_and_shift():
    keys = {name: [row[0] for row in rows] for name, rows in SHOWN.items()}
    assert keys == {
        'controllers': own_controller_names(),
        'handovers': [f'{each}, {name}' for each in HANDOVERS for name in SOME],
        'scenarios': [f'`{each}`, {name}' for each in shift_scenarios() for name in SOME],
    }, MAKE


@pytest.mark.parametrize(
    ('table', 'key', 'case'),
    [
        ('controllers', 'mpc3', (SCENARIO, 'adaptive', 'mpc3')),
        ('handovers', 'slip, hinf2', (SCENARIO, 'slip', 'hinf2')),
        ('scenarios', '`upshift_hot`, ls8', ('upshift_hot', 'adaptive', 'ls8')),
    ],
)
def test_a_row_of_each_table_is_what_its_run_gives(table, key, case):
    (shown,) = [row[1:] for row in SHOWN[table] if row[0] == key]
    assert shown == shift_row(case), MAKE


def test_the_picture_is_drawn_from_the_run():
    picture = DOCS / 'images' / f'{CHART}.png'
    with chart_style():
        expected = curves_of(phases_chart())
    drawn = drawn_curves(picture)
    assert set(drawn) == {'Speeds', 'Torques of both clutches', 'Torque at the wheels'}
    for panel, lines in expected.items():
        for label, values in lines.items():
            assert drawn[panel][label] == pytest.approx(values, abs=1.0, rel=1e-3), MAKE
    assert picture.stat().st_size < 150_000
