# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Program `thesis studies`: the studies, and their printed and written output."""

import json

import numpy as np
import pytest

from ddct_bringup.programs import thesis
from ddct_bringup.reproduction.studies import command
from ddct_bringup.reproduction.studies.command import STUDIES
from ddct_bringup.reproduction.studies.engagements import Slip, engagement_chart
from ddct_bringup.reproduction.studies.study import Study
from ddct_controllers.design.drawing.chart_style import chart_bytes
from ddct_controllers.registry import own_controller_names

FIRST = Study('The first', ('name', 'value'), [('a', '1'), ('b', '2')], ('Lower is better.',))
SECOND = Study('The second', ('name',), [('c',)])


@pytest.fixture(autouse=True)
def two_studies(monkeypatch):
    """Replace the studies, so that these tests need no closed loops."""
    monkeypatch.setattr(command, 'STUDIES', {'first': lambda: FIRST, 'second': lambda: SECOND})


def test_without_options_every_study_is_printed_with_its_remarks(capsys):
    assert thesis.main(['studies']) == 0
    output = capsys.readouterr()
    assert output.out.index('The first') < output.out.index('Lower is better.')
    assert output.out.index('Lower is better.') < output.out.index('The second')
    progress = ['ddct thesis studies: first', 'ddct thesis studies: second']
    assert output.err.splitlines() == progress


def test_the_help_lists_every_study_with_what_it_is_about(capsys, monkeypatch):
    monkeypatch.setattr(command, 'STUDIES', STUDIES)
    with pytest.raises(SystemExit):
        thesis.main(['studies', '--help'])
    listed = capsys.readouterr().out.partition('\nstudies:\n')[2].partition('\nexamples:')[0]
    lines = [line.split(maxsplit=1) for line in listed.splitlines() if line[2:3].strip()]
    assert [name for name, about in lines if about] == list(STUDIES)
    assert max(map(len, listed.splitlines())) <= 80


def test_json_on_standard_output_has_no_other_text_and_a_mapping_per_row(capsys):
    assert thesis.main(['studies', '--study', 'first', '--json', '-']) == 0
    assert json.loads(capsys.readouterr().out) == {
        'first': {
            'title': 'The first',
            'headers': ['name', 'value'],
            'rows': [{'name': 'a', 'value': '1'}, {'name': 'b', 'value': '2'}],
            'remarks': ['Lower is better.'],
        }
    }


def test_charts_come_as_picture_and_drawing_with_their_data(monkeypatch, tmp_path):
    rpm = np.array([2.0, 1.0, 0.5])
    slips = [Slip('pi', worn, 'engaged', 1, rpm + float(worn)) for worn in ('0', '1', '2')]
    drawn = Study('Drawn', ('name',), [('c',)], draw=lambda: engagement_chart('Drawn', slips))
    monkeypatch.setattr(command, 'STUDIES', {'plain': lambda: SECOND, 'drawn': lambda: drawn})
    assert thesis.main(['studies', '--json', '-', '--charts', str(tmp_path)]) == 0
    files = sorted(file.name for file in tmp_path.iterdir())
    assert files == ['drawn.csv', 'drawn.png', 'drawn.svg']
    data = (tmp_path / 'drawn.csv').read_text(encoding='utf-8').splitlines()
    headings = ','.join(f'"pi: K_usura {worn}: w_d, rpm"' for worn in '012')
    assert data[0].endswith(headings)
    assert data[1:] == ['0,2,3,4', '0.01,1,2,3', '0.02,0.5,1.5,2.5']


@pytest.mark.nightly
@pytest.mark.slow
def test_the_chart_of_every_controller_is_a_picture_of_less_than_150_kb():
    time_s = 0.01 * np.arange(301)
    slips = [
        Slip(name, gain, 'engaged', 60, 200.0 * np.exp(-float(gain) * (1.0 + 0.1 * k) * time_s))
        for k, name in enumerate(own_controller_names())
        for gain in ('0.7', '1', '1.3')
    ]
    assert len(chart_bytes(engagement_chart('Every controller', slips), 'png')) < 150e3


def range_of_panels(*states: str) -> tuple[float, float]:
    """Return the range in rpm of slips in -20 to 80 rpm, of which others grow without limit."""
    good, bad = np.array([80.0, 20.0, -20.0]), np.array([80.0, 1e4, 1e6])
    slips = [
        Slip('pi', f'{place}', state, 1, good / (1 + place) if state == 'engaged' else bad)
        for place, state in enumerate(states)
    ]
    return engagement_chart('Drawn', slips).axes[0].get_ylim()


def test_the_panels_leave_a_margin_around_engaged_runs_and_no_room_for_others():
    assert range_of_panels('engaged', 'engaged', 'engaged') == pytest.approx((-35.0, 95.0))
    assert range_of_panels('engaged', 'not_engaged', 'not_engaged') == pytest.approx((-35.0, 95.0))


def test_unknown_study_is_refused_before_the_work(capsys):
    assert thesis.main(['studies', '--study', 'first', '--study', 'third']) == 1
    (error,) = capsys.readouterr().err.splitlines()
    assert error.startswith('ddct thesis: ')
    assert all(name in error for name in ('third', 'first', 'second'))
