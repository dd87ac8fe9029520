# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller in a file runs like any other, under the name in the file."""

import json

import pytest
from drawn_charts import leave_out_time_charts
from drawn_here import draw_here

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.programs.compare import main as compare
from ddct_bringup.run.execution import execute
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.plan import RunPlan
from ddct_controllers.from_file.designed import DesignedController
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

pytestmark = pytest.mark.slow

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis', ['duration_s=1.0'])))


@pytest.fixture
def file(tmp_path):
    """Return the path of LS8 in a file, called mine."""
    path = tmp_path / 'somewhere' / 'any_name.yaml'
    path.parent.mkdir()
    path.write_text(
        DesignedController('mine', PRINTED_CONTROLLERS['ls8']).to_yaml(), encoding='utf-8'
    )
    return path


def test_the_bag_has_the_name_inside_and_no_path(file, tmp_path):
    plan = RunPlan(SETTINGS, str(file), 'headless')
    folder = tmp_path / plan.name
    folder.mkdir()
    execute(plan, folder)
    assert (folder / 'mine_0.mcap').is_file()
    assert read_bag(folder).facts.controller == 'mine'
    for written in folder.iterdir():
        assert b'any_name' not in written.read_bytes()


def test_it_gives_to_the_bit_the_run_of_the_same_controller_in_the_registry(file):
    from_file = run_headless(SETTINGS, str(file))
    assert from_file.sha256() == run_headless(SETTINGS, 'ls8').sha256()


def test_compare_scores_it_beside_the_others(file, tmp_path, capsys, monkeypatch):
    draw_here(monkeypatch)
    leave_out_time_charts(monkeypatch)
    out = tmp_path / 'runs'
    names = f'ls8,{file}'
    options = ['--floors', 'none', '--headless', '--out', str(out)]
    assert compare(['--controllers', names, *options]) == 0
    ls8, mine = json.loads((out / 'scores.json').read_text(encoding='utf-8'))['runs']
    assert (mine['controller'], mine['bag']) == ('mine', 'mine')
    assert mine['metrics']['engagement_time_s'] == ls8['metrics']['engagement_time_s']
    told = capsys.readouterr().err
    assert 'ls8: G_c(s)' not in told
    assert 0 < told.index('mine: G_c(s) = ') < told.index('2 of 2, mine: ')
    evidence = json.loads((out / 'frequency.json').read_text(encoding='utf-8'))
    assert [entry['controller'] for entry in evidence['controllers']] == ['ls8', 'mine']


def test_two_files_of_one_name_are_refused(file, tmp_path, capsys):
    out = tmp_path / 'runs'
    names = f'{file},{file}'
    assert compare(['--controllers', names, '--headless', '--out', str(out)]) == 1
    assert '--controllers names mine twice' in capsys.readouterr().err
    assert not out.exists()
