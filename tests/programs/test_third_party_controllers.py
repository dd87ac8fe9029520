# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A controller of another package works in every program by its name; a broken one is named."""

import json
import re
import sys
from importlib.metadata import entry_points
from pathlib import Path

import pytest
from support.complaints import assert_one_line
from support.runs import bag_bytes, expected, plan, record
from support.third_party import EXAMPLE, example_entry_points, install, install_broken

from ddct_bringup.programs import bringup, compare, ddct, score, verify
from ddct_controllers import plugins, registry
from ddct_controllers.linear import PI
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings

SUPPORT = Path(__file__).parent.parent
HEADLESS, IN_ONE_PROCESS = '--headless', '--single-process'


@pytest.fixture
def example(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    install(monkeypatch, tmp_path / 'site', EXAMPLE, example_entry_points())


@pytest.fixture
def broken(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    install_broken(monkeypatch, tmp_path / 'site')


@pytest.mark.usefixtures('example')
def test_the_example_controller_runs_in_every_layout_with_the_same_bytes(tmp_path: Path) -> None:
    changes = ('controllers.dead_zone.dead_zone_rpm=2.0',)
    bags = []
    for layout in ('processes', 'single-process', 'headless'):
        run = plan('dead_zone', layout, changes=changes)
        trajectory = record(run, tmp_path / layout).trajectory
        assert trajectory.sha256() == expected(run).sha256()
        assert trajectory.slip_reference.shape[1] == 2, 'its preview is one step'
        assert dict(trajectory.status[-1])['in_dead_zone'] in ('true', 'false')
        bags.append(bag_bytes(tmp_path / layout))
    assert bags[0] == bags[1] == bags[2]


@pytest.mark.nightly
@pytest.mark.usefixtures('example')
def test_bringup_lists_and_runs_the_example_controller(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    assert bringup.main(['--list']) == 0
    lines = capfd.readouterr().out.splitlines()
    assert lines[0].startswith('controllers:')
    named = ' '.join(lines).partition('KEY')[0]
    assert 'dead_zone' in named
    first = next(at for at, line in enumerate(lines) if 'dead_zone_rpm' in line)
    row = ' '.join(' '.join(lines[first : first + 2]).split())
    assert row.startswith('dead_zone_rpm dead_zone 5 half the width of the dead zone')
    out = tmp_path / 'runs'
    assert bringup.main(['--controller', 'dead_zone', '--headless', '--out', str(out)]) == 0
    assert (out / 'dead_zone' / 'dead_zone_0.mcap').is_file()


@pytest.mark.usefixtures('example')
def test_a_gain_that_the_example_does_not_take_is_named(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    arguments = ['--controller', 'dead_zone', '--set', 'controllers.dead_zone.speed=1']
    assert bringup.main([*arguments, '--headless', '--out', str(tmp_path / 'runs')]) == 1
    assert_one_line(capfd.readouterr().err, 'bringup', 'controllers.dead_zone.speed')
    assert not (tmp_path / 'runs').exists()


@pytest.mark.usefixtures('no_page')
@pytest.mark.parametrize(
    'command',
    [
        ['design', 'margins'],
        ['compare', '--headless', '--duration', '0.7', '--out', 'runs'],
        ['compare', '--list'],
    ],
    ids=['margins', 'compare', 'list'],
)
def test_a_controller_that_cannot_be_built_stops_only_the_programs_that_need_it(
    command: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    install(monkeypatch, tmp_path / 'absent', SUPPORT, {'absent': 'no_such_package:make'})
    monkeypatch.setattr(registry, '_OWN', {'pi': PI})
    monkeypatch.setattr(plugins, '_installed', lambda _: entry_points(name='absent'))
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, 'argv', ['ddct', *command])
    assert ddct.main() == 0
    printed = capfd.readouterr()
    words = ' '.join((printed.out + printed.err).split())
    complaint = "controller 'absent': the entry point no_such_package:make cannot be loaded"
    assert words.count(complaint) == words.count('no_such_package:make') == 1
    assert re.search(r'^(controllers:)? *pi\b', printed.out, re.MULTILINE)
    monkeypatch.setattr(sys, 'argv', ['ddct', 'design', 'margins', '--controllers', 'absent'])
    assert ddct.main() == 1


@pytest.mark.usefixtures('broken')
@pytest.mark.parametrize(
    ('name', 'words'),
    [
        ('absent', ["'absent'", 'no_such_package', 'cannot be loaded']),
        ('no_controller', ["'no_controller'", 'returned dict']),
        ('nothing', ["'nothing'", 'KeyError']),
    ],
)
def test_a_controller_that_cannot_be_built_is_named(name: str, words: list[str]) -> None:
    with pytest.raises(DdctError) as failure:
        make_controller(name, KnownSettings(load_scenario('thesis')))
    for word in words:
        assert word in str(failure.value)


@pytest.mark.usefixtures('broken')
@pytest.mark.parametrize(
    ('layout', 'name', 'words'),
    [
        (HEADLESS, 'not_a_number', 'torque at step 60 is nan'),
        pytest.param(HEADLESS, 'infinite', 'torque at step 60 is inf', marks=pytest.mark.nightly),
        (HEADLESS, 'bare_number', 'float'),
        (HEADLESS, 'text', "'12.5'"),
        (HEADLESS, 'bad_status', "status at step 60 is (('iterations', 3),)"),
        (HEADLESS, 'raising', 'failed at step 60 (ZeroDivisionError: float division by zero, in '),
        (HEADLESS, 'leaving', 'failed at step 60 (SystemExit: 3, in '),
        (IN_ONE_PROCESS, 'bad_status', "status at step 60 is (('iterations', 3),)"),
        (IN_ONE_PROCESS, 'leaving', 'failed at step 60 (SystemExit: 3, in '),
    ],
)
def test_a_command_that_cannot_be_used_ends_the_run_with_one_line(
    capfd: pytest.CaptureFixture[str], tmp_path: Path, layout: str, name: str, words: str
) -> None:
    out = tmp_path / 'runs'
    assert bringup.main(['--controller', name, layout, '--out', str(out)]) == 1
    place = 'broken_controllers.py line '
    assert_one_line(capfd.readouterr().err, 'bringup', f'controller {name!r}: it', words, place)
    assert not (out / name).exists()


@pytest.mark.usefixtures('broken')
def test_a_controller_that_outlasts_its_period_is_named_without_real_time_too(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    options = ['--headless', '--duration', '1.2', '--out', str(tmp_path / 'runs')]
    assert bringup.main(['--controller', 'slow', *options]) == 0
    assert 'too slow for real time' in capfd.readouterr().err
    assert score.main([str(tmp_path / 'runs')]) == 0
    assert 'too slow for real time' in capfd.readouterr().out


@pytest.mark.usefixtures('broken')
def test_compare_runs_and_names_a_controller_whose_linear_model_is_none(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    out = tmp_path / 'runs'
    options = ['--headless', '--duration', '1', '--out', str(out)]
    assert compare.main(['--controllers', 'bad_linear_model,pi', *options]) == 1
    *_, last = capfd.readouterr().err.splitlines()
    assert last.startswith(
        "ddct compare: controller 'bad_linear_model': its linear_model cannot be"
    )
    assert 'it is of type list' in last
    assert f'{SUPPORT}/support/broken_controllers.py line ' in last
    runs = json.loads((out / 'scores.json').read_text())['runs']
    assert [(each['controller'], each['valid']) for each in runs] == [
        ('bad_linear_model', True),
        ('pi', True),
    ]
    entries = json.loads((out / 'frequency.json').read_text())['controllers']
    assert [entry['linear'] for entry in entries] == [None, True]
    assert 'its linear_model cannot be used: it is of type list' in (
        out / 'report.html'
    ).read_text(encoding='utf-8')
    assert verify.main([str(out)]) == 0


@pytest.mark.usefixtures('broken', 'no_page')
def test_compare_goes_on_after_a_controller_that_commands_no_number(
    tmp_path: Path,
) -> None:
    out = tmp_path / 'runs'
    options = ['--headless', '--duration', '1', '--out', str(out)]
    assert compare.main(['--controllers', 'not_a_number,pi', *options]) == 1
    bad, good = json.loads((out / 'scores.json').read_text())['runs']
    assert (bad['controller'], bad['valid']) == ('not_a_number', False)
    assert 'torque at step 60 is nan' in bad['reason']
    assert (good['controller'], good['valid']) == ('pi', True)


@pytest.mark.usefixtures('broken')
def test_bringup_names_the_controller_that_raised_and_keeps_its_traceback_in_a_log(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / 'runs'
    assert bringup.main(['--controller', 'raising', '--out', str(out)]) == 1
    errors = capfd.readouterr().err
    words = "controller 'raising': it failed at step 60 (ZeroDivisionError: float division by zero"
    assert_one_line(errors, 'bringup', 'node controller', words)
    log = out / 'raising.partial' / 'work' / 'controller.log'
    assert str(log) in errors
    assert 'Traceback' in log.read_text(encoding='utf-8')
    assert not (out / 'raising').exists()
