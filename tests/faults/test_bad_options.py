# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every invalid option or scenario ends `bringup` with one line before anything runs."""

from pathlib import Path
from textwrap import indent

import pytest
from support.complaints import assert_one_line
from support.processes import Programs

from ddct_bringup.programs import bringup, compare

BAD_OPTIONS = {
    'controller': (['--controller', 'pid'], ["'pid'", 'choose from', 'hinf1']),
    'controller typo': (['--controller', 'ls88'], ["'ls88'", 'choose from']),
    'architecture': (['--architecture', 'detail'], ["'detail'", 'detailed']),
    'clutch': (['--set', 'clutch=dry'], ["'dry'", 'linear']),
    'mode': (['--mode', 'fast'], ["'fast'", 'lockstep', 'realtime']),
    'scenario': (['--scenario', 'theses'], ["'theses'", 'thesis', 'YAML file']),
    'car': (['--car', 'city8'], ['unknown car', 'did you mean city7?', 'c635_no_limits']),
    'drive': (['--drive', 'upshfit'], ['unknown drive', 'did you mean upshift?', 'launch_hot']),
    'car of another clutch': (
        ['--car', 'c635_thesis', '--drive', 'tip_in'],
        ['clutch linear would ignore', 'initial.clutch_phase'],
    ),
    'scenario file': (['--scenario', 'no/such.yaml'], ['no/such.yaml', 'cannot be read']),
    'wear gain zero': (['--wear-gain', '0'], ['wear_gain is 0', 'above 0']),
    'wear gain too large': (['--wear-gain', '3.1'], ['wear_gain is 3.1', 'at most 3']),
    'wear gain nan': (['--wear-gain', 'nan'], ['wear_gain is nan', 'finite']),
    'seed': (['--seed', '-1'], ['seed is -1', 'at least 0']),
    'duration negative': (['--duration', '-1'], ['duration_s is -1', 'above 0']),
    'duration off grid': (['--duration', '0.705'], ['duration_s is 0.705', 'multiple of 0.01']),
    'duration nan': (['--duration', 'nan'], ['duration_s', 'nan', 'number']),
    'duration without end': (['--duration', 'inf'], ['duration_s', 'inf', 'number']),
    'set without value': (['--set', 'duration_s'], ['--set duration_s', 'KEY=VALUE']),
    'set without key': (['--set', '=3'], ['--set =3', 'KEY=VALUE']),
    'set unknown key': (['--set', 'load.slop_rad=0.1'], ['load.slop_rad', 'load.slope_rad?']),
    'set unknown part': (['--set', 'laod.slope_rad=0.1'], ['laod', 'load?']),
    'set key below a value': (['--set', 'duration_s.x=1'], ['duration_s', 'value']),
    'set text': (['--set', 'load.slope_rad=steep'], ['load.slope_rad', "'steep'", 'number']),
    'set nan': (['--set', 'load.slope_rad=.nan'], ['load.slope_rad is nan', 'finite']),
    'set nothing': (['--set', 'load.slope_rad='], ['load.slope_rad', 'empty']),
    'set no yaml': (['--set', 'load.slope_rad=[1'], ['--set load.slope_rad=[1', 'YAML']),
    'set out of range': (['--set', 'vehicle.mass_kg=-1'], ['vehicle.mass_kg is -1']),
    'set unknown gain': (['--set', 'controllers.pi.kd=1'], ['controllers.pi.kd', 'integral_gain']),
}


@pytest.mark.parametrize(('options', 'words'), BAD_OPTIONS.values(), ids=BAD_OPTIONS)
def test_a_bad_option_is_named_and_nothing_is_written(
    capfd: pytest.CaptureFixture[str], tmp_path: Path, options: list[str], words: list[str]
) -> None:
    out = tmp_path / 'runs'
    assert bringup.main([*options, '--out', str(out)]) == 1
    printed = capfd.readouterr()
    assert_one_line(printed.err, 'bringup', *words)
    assert not printed.out
    assert not out.exists()


BAD_SCENARIOS = {
    'nan in a profile': ('engine.torque_n_m: [0.0, .nan]', ['engine.torque_n_m[1]', 'nan']),
    'infinite duration': ('duration_s: .inf', ['duration_s is inf', 'finite']),
    'nan in the load': ('load: {slope_rad: .nan}', ['load.slope_rad is nan']),
    'unknown key': ('durration_s: 2.0', ['durration_s', 'duration_s?']),
    'unknown deep key': ('vehicle: {mas_kg: 1200.0}', ['vehicle.mas_kg', 'vehicle.mass_kg?']),
    'value for keys': ('load: 3', ['load', 'give keys and values']),
    'empty value': ('duration_s:', ['duration_s', 'empty']),
    'window backwards': ('score_window_s: [2.0, 0.6]', ['score_window_s', 'before']),
    'bad yaml': ('load: [1, 2', ['not valid YAML', 'line']),
    'no mapping': ('- a\n- b', ['mapping']),
    'key of the car': ('friction: {most_n_m: 9.0}', ['friction is a key of the car']),
}

HEAD = """\
car: c635_thesis
controllers: {pi: {proportional_gain: 0.002, integral_gain: 0.1449}}
drive:
"""
BASE = """\
duration_s: 3.0
control_start_s: 0.6
score_window_s: [0.6, 2.0]
engine: {time_s: [0.0, 0.5], torque_n_m: [0.0, 290.0]}
"""
"""Drive of the scenario."""


def _scenario(change: str) -> str:
    """Return the base scenario with one line changed, added or, if it is no mapping, replaced."""
    key, colon, _ = change.partition(':')
    if not colon:
        return change
    if key == 'engine.torque_n_m':
        drive = BASE.replace('torque_n_m: [0.0, 290.0]', change.removeprefix('engine.'))
        return HEAD + indent(drive, '  ')
    kept = [line for line in BASE.splitlines() if not line.startswith(f'{key}:')]
    if key == 'vehicle':
        return f'{HEAD}{indent(BASE, "  ")}'.replace('c635_thesis', f'{{{change}}}')
    return HEAD + indent('\n'.join([*kept, change]), '  ')


def test_the_base_of_the_bad_scenarios_is_good(tmp_path: Path) -> None:
    file = tmp_path / 'mine.yaml'
    file.write_text(HEAD + indent(BASE, '  '), encoding='utf-8')
    out = tmp_path / 'runs'
    assert bringup.main(['--scenario', str(file), '--headless', '--out', str(out)]) == 0


@pytest.mark.parametrize(('change', 'words'), BAD_SCENARIOS.values(), ids=BAD_SCENARIOS)
def test_a_bad_scenario_file_is_named_with_its_key(
    capfd: pytest.CaptureFixture[str], tmp_path: Path, change: str, words: list[str]
) -> None:
    file = tmp_path / 'mine.yaml'
    file.write_text(_scenario(change), encoding='utf-8')
    out = tmp_path / 'runs'
    assert bringup.main(['--scenario', str(file), '--headless', '--out', str(out)]) == 1
    assert_one_line(capfd.readouterr().err, 'bringup', str(file), *words)
    assert not out.exists()


@pytest.mark.parametrize(
    ('options', 'words'),
    [
        (['--headless', '--single-process'], 'not allowed with'),
        (['--wear-gain', 'old'], "'old' is no number: give a number alone"),
        (['--seed', '1.5'], "invalid int value: '1.5'"),
        (['--speed', '3'], 'unrecognized arguments'),
    ],
)
def test_options_that_cannot_be_parsed_end_with_usage_and_code_2(
    capfd: pytest.CaptureFixture[str], tmp_path: Path, options: list[str], words: str
) -> None:
    with pytest.raises(SystemExit) as end:
        bringup.main([*options, '--out', str(tmp_path / 'runs')])
    assert end.value.code == 2
    assert words in capfd.readouterr().err


def test_out_must_be_given(capfd: pytest.CaptureFixture[str]) -> None:
    assert bringup.main([]) == 1
    assert_one_line(capfd.readouterr().err, 'bringup', '--out is missing')


def test_a_real_time_run_without_a_graph_is_refused(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    out = tmp_path / 'runs'
    assert bringup.main(['--mode', 'realtime', '--headless', '--out', str(out)]) == 1
    assert_one_line(capfd.readouterr().err, 'bringup', '--headless', 'realtime')
    assert not out.exists()


@pytest.mark.parametrize('domain', ['abc', '-1', '1000'])
def test_a_bad_domain_is_named(
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    domain: str,
) -> None:
    monkeypatch.setenv('ROS_DOMAIN_ID', domain)
    out = str(tmp_path / 'runs')
    assert bringup.main(['--duration', '0.7', '--single-process', '--out', out]) == 1
    assert_one_line(capfd.readouterr().err, 'bringup', 'ROS_DOMAIN_ID', repr(domain))


def test_the_program_exits_with_the_code_that_main_returns(
    programs: Programs, tmp_path: Path
) -> None:
    out = tmp_path / 'runs'
    arguments = ('--controller', 'pid', '--out', str(out))
    program = programs.start_module('ddct_bringup.programs.bringup', *arguments)
    assert program.wait() == 1
    assert_one_line(program.errors(), 'bringup', "'pid'")
    assert not program.output()


def test_a_section_for_an_unknown_controller_is_refused(tmp_path, capsys):
    """The section would change nothing, although the table's title would list it."""
    options = ['--headless', '--out', str(tmp_path / 'x'), '--set', 'controllers.mpc_4.gain=3']
    assert compare.main(['--controllers', 'pi', *options]) == 1
    assert 'controllers.mpc_4: there is no such controller' in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_json_without_a_folder_is_refused_before_anything_runs(tmp_path, capsys):
    target = tmp_path / 'absent' / 'scores.json'
    options = ['--headless', '--out', str(tmp_path / 'x'), '--json', str(target)]
    assert compare.main(['--controllers', 'pi', *options]) == 1
    assert 'there is no folder' in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_usage_error_is_one_line(capsys):
    with pytest.raises(SystemExit) as end:
        compare.main(['--nonsense'])
    complaint = capsys.readouterr().err
    assert end.value.code == 2
    assert complaint.splitlines() == [
        'ddct compare: unrecognized arguments: --nonsense: see ddct compare --help'
    ]
