# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Hostile names and texts in options do no harm outside the run's folder."""

import importlib
import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest
from samples import sampled
from support.complaints import assert_one_line
from support.processes import Program, Programs, package_of

from ddct_bringup.processes.graph_nodes import NODE_PROGRAMS
from ddct_bringup.programs import bringup
from ddct_plant.scenario.file import load_scenario, scenario_to_yaml

ROOT = Path(__file__).resolve().parents[2]
TOO_LONG = 'x' * 300


def everything_in(folder: Path) -> set[Path]:
    return set(folder.rglob('*'))


@pytest.mark.parametrize('layout', ['--headless', '--single-process'])
@pytest.mark.parametrize('where', ['../../../../evil', 'absolute'])
def test_a_scenarios_name_writes_nothing_outside_the_runs_folder(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], layout: str, where: str
) -> None:
    victim = tmp_path / 'evil.yaml'
    victim.write_text('mine', encoding='utf-8')
    name = str(tmp_path / 'evil') if where == 'absolute' else where
    scenario = tmp_path / 'scenario.yaml'
    text = scenario_to_yaml(load_scenario('thesis', ['duration_s=1']))
    scenario.write_text(text.replace('name: thesis', f'name: {name}'), encoding='utf-8')
    before = everything_in(tmp_path)
    out = tmp_path / 'a' / 'b' / 'runs'
    assert bringup.main(['--scenario', str(scenario), layout, '--out', str(out)]) == 1
    assert_one_line(capfd.readouterr().err, 'bringup', str(scenario), 'name is')
    assert victim.read_text(encoding='utf-8') == 'mine'
    assert everything_in(tmp_path) == before


@pytest.mark.parametrize(
    'options',
    [
        ['--out', TOO_LONG],
        ['--out', 'runs', '--controller', TOO_LONG],
        ['--out', 'runs', '--controller', f'{TOO_LONG}.yaml'],
        ['--out', 'runs', '--scenario', f'{TOO_LONG}.yaml'],
        ['--out', 'runs', '--set', f'name={TOO_LONG}'],
        ['--out', 'runs', '--architecture', TOO_LONG],
    ],
)
def test_a_name_of_300_characters_is_one_line(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
    options: list[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert bringup.main(['--headless', *options]) == 1
    assert_one_line(capfd.readouterr().err, 'bringup', TOO_LONG)
    assert everything_in(tmp_path) == set()


@pytest.mark.parametrize(
    'module',
    [
        'ddct_bringup.programs.score',
        'ddct_bringup.record.recorder_node',
    ],
)
def test_help_into_a_full_disk_is_one_line(module: str) -> None:
    with Path('/dev/full').open('w') as full:
        done = subprocess.run(
            [sys.executable, '-m', module, '--help'],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert done.returncode == 1
    name = module.rpartition('.')[2].removesuffix('_program')
    program = name.removesuffix('_node') if name.endswith('_node') else f'ddct {name}'
    assert_one_line(done.stderr, program, 'No space left on device')


WRAPPERS = ('run_program', 'run_subcommands', 'run_late_subcommands', 'run_node')
"""Wrappers of programs' main; the two of subcommands call `run_program`."""


@pytest.mark.parametrize('package', sorted({package_of(spec) for spec in NODE_PROGRAMS}))
def test_every_program_ends_through_the_one_wrapper(package: str) -> None:
    setup = (ROOT / package / 'setup.py').read_text(encoding='utf-8')
    programs = re.findall(r"'[a-z-]+ = ([a-z_.]+):main'", setup)
    assert programs
    for program in programs:
        main = inspect.getsource(importlib.import_module(program).main)
        assert any(f'{end}(' in main for end in WRAPPERS), program


@pytest.mark.parametrize('home', sampled(['/proc/nowhere', None], every=2))
def test_without_a_home_the_advice_is_to_name_a_folder_for_the_logs(
    programs: Programs, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, home: str | None
) -> None:
    for name in ('HOME', 'ROS_HOME', 'ROS_LOG_DIR'):
        monkeypatch.delenv(name, raising=False)
    if home:
        monkeypatch.setenv('HOME', home)
    run = bring_up(programs, tmp_path / 'without')
    assert run.wait() == 1
    assert 'Traceback' not in run.errors()
    advice = 'set HOME or ROS_LOG_DIR to a folder that can be written'
    assert run.errors().splitlines()[-1].endswith(advice)
    if home:
        monkeypatch.setenv('ROS_LOG_DIR', str(tmp_path / 'logs'))
        run = bring_up(programs, tmp_path / 'with')
        assert run.wait() == 0, run.errors()


def bring_up(programs: Programs, out: Path) -> Program:
    arguments = ['--single-process', '--duration=0.7', f'--out={out}']
    return programs.fork('ddct_bringup.programs.bringup', *arguments)
