# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Programs, bags and nodes report scenario values that were adjusted to agree."""

from pathlib import Path

import pytest
from support.processes import Programs

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.programs import bringup, compare, score
from ddct_plant.scenario.file import load_scenario, scenario_to_yaml

MOVED = 'driveline.vehicle_inertia moved from 154.691 to 185.629'
HEAVY = ['--set', 'vehicle.mass_kg=1800', '--duration', '1.8', '--headless']


def test_bringup_prints_adjusted_values_the_bag_keeps_them_and_score_repeats_them(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    out = tmp_path / 'runs'
    assert bringup.main([*HEAVY, '--out', str(out)]) == 0
    assert f'scenario thesis: {MOVED}' in capfd.readouterr().err
    settings = read_bag(out / 'pi').settings
    assert settings is not None
    assert settings.scenario.adjusted[0].startswith(MOVED)
    assert settings.scenario.driveline.vehicle_inertia == pytest.approx(185.62926)
    assert score.main([str(out)]) == 0
    assert f'ddct score: pi: {MOVED}' in capfd.readouterr().err


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


def test_compare_prints_adjusted_values_above_its_table(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    assert compare.main([*HEAVY, '--controllers', 'pi', '--out', str(tmp_path / 'runs')]) == 0
    table = capfd.readouterr().out
    assert table.startswith(MOVED)
    assert 'thesis row' not in table


def test_a_contradiction_is_one_line_and_leaves_nothing(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    arguments = ['--set', 'driveline.vehicle_inertia=154.69', '--out', str(tmp_path / 'runs')]
    assert bringup.main([*HEAVY, *arguments]) == 1
    (line,) = capfd.readouterr().err.splitlines()
    assert 'give driveline.vehicle_inertia 185.629' in line
    assert not (tmp_path / 'runs').exists()


WHOLE = scenario_to_yaml(load_scenario('thesis', ['vehicle.mass_kg=1800']))
"""Scenario as `bringup` writes it for its nodes."""
HALF = """\
car: {vehicle: {mass_kg: 1800.0}}
drive:
  duration_s: 1.0
  control_start_s: 0.6
  score_window_s: [0.6, 1.0]
  engine: {time_s: [0.0], torque_n_m: [100.0]}
"""


@pytest.mark.parametrize('text', [WHOLE, HALF], ids=['whole', 'half'])
def test_a_node_logs_adjusted_values(programs: Programs, tmp_path: Path, text: str) -> None:
    path = tmp_path / 'heavy.yaml'
    path.write_text(text, encoding='utf-8')
    arguments = ('--help', '--ros-args', '-p', f'scenario:={path}')
    node = programs.start_module('ddct_plant.nodes.load_node', *arguments)
    assert node.wait() == 0
    assert MOVED in node.errors()
