# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Programs, bags and nodes report remarks on the values of a scenario."""

from pathlib import Path

import pytest
from support.processes import Programs
from waiting import wait_until

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.programs import bringup, compare, score
from ddct_plant.scenario.file import load_scenario, scenario_to_yaml

REMARK = 'score_window_s [0.2, 1.7] begins before control_start_s, 0.6 s'
EARLY = ['--set', 'score_window_s=[0.2, 1.7]', '--duration', '1.8', '--headless']


def test_bringup_prints_remarks_the_bag_keeps_them_and_score_repeats_them(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    out = tmp_path / 'runs'
    assert bringup.main([*EARLY, '--out', str(out)]) == 0
    assert f'scenario thesis: {REMARK}' in capfd.readouterr().err
    settings = read_bag(out / 'pi').settings
    assert settings is not None
    assert settings.scenario.adjusted[0].startswith(REMARK)
    assert score.main([str(out)]) == 0
    assert f'ddct score: pi: {REMARK}' in capfd.readouterr().err


@pytest.mark.usefixtures('no_page')
def test_a_mass_in_tonnes_runs_and_every_program_warns_on_standard_error(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    warning = 'vehicle.mass_kg is 1.5 kg, but cars and trucks have 300 to 50000 kg'
    light = ['--set', 'vehicle.mass_kg=1.5', '--duration', '1.8', '--headless']
    assert bringup.main([*light, '--out', str(tmp_path / 'runs')]) == 0
    assert warning in capfd.readouterr().err
    assert score.main([str(tmp_path / 'runs')]) == 0
    assert warning in capfd.readouterr().err
    assert compare.main([*light, '--controllers', 'pi', '--out', str(tmp_path / 'both')]) == 0
    assert warning in capfd.readouterr().err


@pytest.mark.usefixtures('no_page')
def test_compare_prints_remarks_above_its_table(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    assert compare.main([*EARLY, '--controllers', 'pi', '--out', str(tmp_path / 'runs')]) == 0
    table = capfd.readouterr().out
    assert table.startswith(REMARK)
    assert 'thesis row' not in table


def test_a_contradiction_is_one_line_and_leaves_nothing(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    three = (
        'vehicle.mass_kg=1800',
        'vehicle.wheel_radius_m=0.3',
        'driveline.vehicle_inertia=154.69',
    )
    changes = [argument for each in three for argument in ('--set', each)]
    assert bringup.main([*changes, '--headless', '--out', str(tmp_path / 'runs')]) == 1
    (line,) = capfd.readouterr().err.splitlines()
    assert 'm_v r_w^2 is 162 kg m^2: give two of them' in line
    assert not (tmp_path / 'runs').exists()


WHOLE = scenario_to_yaml(load_scenario('thesis', ['score_window_s=[0.2, 1.7]']))
"""Scenario as `bringup` writes it for its nodes."""
HALF = """\
car: c635
drive:
  duration_s: 2.0
  control_start_s: 0.6
  score_window_s: [0.2, 1.7]
  engine: {time_s: [0.0], torque_n_m: [100.0]}
"""


@pytest.mark.parametrize('text', [WHOLE, HALF], ids=['whole', 'half'])
def test_a_node_logs_remarks(programs: Programs, tmp_path: Path, text: str) -> None:
    path = tmp_path / 'early.yaml'
    path.write_text(text, encoding='utf-8')
    arguments = ('--ros-args', '-p', f'scenario:={path}')
    node = programs.fork('ddct_plant.nodes.load_node', *arguments)
    wait_until(lambda: REMARK in node.errors(), 'the remark')
    node.stop()
