# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Values that `compare` prints with Table 5.1, and the conditions for it."""

import dataclasses
import io
import re

import pytest
from made_scores import made_scores

from ddct_bringup.reproduction.numbers.number_files import thesis_numbers
from ddct_bringup.scores.comparison_table import print_comparison
from ddct_bringup.thesis.table_5_1 import PREDICTED, PREDICTION_TOLERANCE, THESIS_TABLE, thesis_row
from ddct_bringup.thesis.table_metrics import TABLE_METRICS
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

THESIS = load_scenario('thesis')
VALUES = (0.62, 1.2, 0.19)


def run(controller, figures=VALUES):
    names = ('engagement_time_s', 'torsion_speed_std_rpm', 'acceleration_std_m_s2')
    return made_scores(controller, **dict(zip(names, figures, strict=True)))


def printed(*runs, settings=None, overrides=()):
    stream = io.StringIO()
    print_comparison(runs, settings or RunSettings(KnownSettings(THESIS)), overrides, stream)
    text = re.sub('(?<= )--+(?= )', '-', stream.getvalue())
    return [' '.join(line.split()) for line in text.splitlines()]


def row_of(lines, controller):
    """Return the words of the row of a controller, with those below its first line."""
    place = next(place for place, line in enumerate(lines) if line.split()[:1] == [controller])
    further = lines[place + 1] if lines[place + 1] in ('hit', 'miss') else ''
    return [*lines[place].split(), *further.split()]


def test_a_predicted_row_has_value_and_print_and_is_a_miss_where_one_value_is():
    lines = printed(run('mpc3'))
    row = row_of(lines, 'mpc3')
    assert row[1:8] == ['0.620', '0.63', '1.200', '0.90', '0.190', '0.19', 'predicted,']
    assert row[-2:] == ['engaged', 'miss']
    assert 'a hit within 25 % in all three values.' in ' '.join(lines)


def test_a_predicted_row_is_a_hit_where_all_three_values_are():
    assert row_of(printed(run('mpc3', (0.62, 0.9, 0.19))), 'mpc3')[-1] == 'hit'


def test_undefined_value_is_a_miss():
    assert row_of(printed(run('mpc3', (None, 0.9, 0.19))), 'mpc3')[-1] == 'miss'


def test_calibrated_row_and_a_controller_without_a_row_neither_hit_nor_miss():
    lines = printed(run('pi'), run('ls1'))
    assert row_of(lines, 'pi')[1:8] == [
        *('0.620', '0.88', '1.200', '0.70', '0.190', '0.18', 'calibrated')
    ]
    assert row_of(lines, 'ls1')[1:8] == ['0.620', '-', '1.200', '-', '0.190', '-', '-']
    assert not {'hit', 'miss'} & {*' '.join(lines).partition('thesis:')[0].split()}


@pytest.mark.parametrize(
    'settings',
    [
        RunSettings(KnownSettings(load_scenario('thesis', ['load.slope_rad=0.01']))),
        RunSettings(KnownSettings(dataclasses.replace(THESIS, duration_s=2.0))),
        RunSettings(KnownSettings(THESIS, 'feedforward')),
        RunSettings(KnownSettings(THESIS), CaseSettings(wear_gain=0.7)),
    ],
    ids=['scenario', 'duration', 'architecture', 'wear'],
)
def test_nothing_of_the_thesis_is_shown_under_other_conditions(settings):
    lines = printed(run('mpc3'), settings=settings)
    assert row_of(lines, 'mpc3')[1:4] == ['0.620', '1.200', '0.190']
    assert '0.90' not in row_of(lines, 'mpc3')
    assert not any('predicted' in line or 'thesis:' in line for line in lines)


@pytest.mark.parametrize(
    ('share', 'hit'), [(0.76, True), (0.74, False), (1.24, True), (1.26, False)]
)
def test_a_prediction_is_a_hit_within_a_quarter_of_the_print(share, hit):
    row = thesis_row('mpc3')
    assert row.hit('torsion_speed_std_rpm', share * 0.90) is hit


def test_the_gate_judges_the_predicted_rows_by_the_same_tolerance():
    gate = {number.id: number.tolerance for number in thesis_numbers()}
    predicted = [row.controller for row in THESIS_TABLE if row.use == PREDICTED]
    for controller in predicted:
        for figure in TABLE_METRICS:
            name = f'5.1 {controller} {figure}'
            assert gate[name].relative == PREDICTION_TOLERANCE, name
