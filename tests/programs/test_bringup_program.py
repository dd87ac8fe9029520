# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Output, files and exit code of `bringup` without faults."""

import json
from pathlib import Path

import pytest

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.programs import bringup


def test_a_run_leaves_one_bag_with_its_timing_and_nothing_else(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    out = tmp_path / 'new' / 'runs'
    arguments = ['--controller', 'ls8', '--duration', '0.8', '--single-process', '--out', str(out)]
    assert bringup.main(arguments) == 0
    left = sorted(path.relative_to(out).as_posix() for path in out.rglob('*') if path.is_file())
    assert [name for name in left if '.ddct-output' not in name] == [
        'ls8/ls8_0.mcap',
        'ls8/manifest.json',
        'ls8/metadata.yaml',
        'ls8/timing.json',
    ]
    assert capfd.readouterr().out == f'{out / "ls8"}\n'


def test_options_reach_the_bag(tmp_path: Path) -> None:
    out = tmp_path / 'runs'
    arguments = ['--wear-gain', '0.7', '--seed', '3', '--set', 'load.slope_rad=0.05']
    arguments += ['--duration', '0.7', '--headless', '--out', str(out)]
    assert bringup.main(arguments) == 0
    recording = read_bag(out / 'pi')
    facts = recording.facts
    assert (facts.controller, facts.architecture, facts.clutch) == ('pi', 'detailed', 'linear')
    assert (facts.scenario, facts.mode, facts.seed) == ('thesis', 'lockstep', 3)
    assert (facts.wear_gain, facts.duration_s) == (0.7, 0.7)
    assert recording.settings is not None
    assert recording.settings.scenario.load.slope_rad == 0.05


def test_a_run_ends_with_its_state_and_the_reason(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    arguments = ['--controller', 'ls8', '--headless', '--out', str(tmp_path / 'runs')]
    assert bringup.main(arguments) == 0
    assert capfd.readouterr().err.endswith('bringup: engaged\n')
    short = [*arguments, '--duration', '0.7', '--overwrite']
    assert bringup.main(short) == 0
    assert 'bringup: not_engaged: the slip, ' in capfd.readouterr().err
    arguments += ['--limits', str(tmp_path / 'none.yaml'), '--overwrite']
    assert bringup.main(arguments) == 1
    assert capfd.readouterr().err.startswith('bringup: limits ')


def test_controllers_share_one_output_folder_and_overwrite_replaces_one(tmp_path: Path) -> None:
    arguments = ['--duration', '0.7', '--headless', '--out', str(tmp_path / 'runs')]
    assert bringup.main(['--controller', 'pi', *arguments]) == 0
    assert bringup.main(['--controller', 'ls8', *arguments]) == 0
    kept = (tmp_path / 'runs' / 'pi' / 'timing.json').read_bytes()
    again = ['--controller', 'ls8', '--wear-gain', '0.5', '--overwrite', *arguments]
    assert bringup.main(again) == 0
    assert read_bag(tmp_path / 'runs' / 'ls8').facts.wear_gain == 0.5
    assert (tmp_path / 'runs' / 'pi' / 'timing.json').read_bytes() == kept
    assert sorted(path.name for path in (tmp_path / 'runs').iterdir()) == [
        '.ddct-output',
        'ls8',
        'pi',
    ]


def test_timing_has_one_update_time_per_step(tmp_path: Path) -> None:
    for layout in ('--single-process', '--headless'):
        out = tmp_path / layout
        assert bringup.main(['--duration', '0.7', layout, '--out', str(out)]) == 0
        timing = json.loads((out / 'pi' / 'timing.json').read_text())
        assert timing['steps'] == 70
        assert len(timing['update_times_us']) == 71
        assert min(timing['update_times_us']) > 0.0
        assert timing['missed_steps'] == 0
        # On a busy machine a tick may be sent again, and its second reply comes too late.
        assert timing['late_messages'] == 0 or timing['resends'] > 0
        assert timing['wall_time_s'] > 0.0


def test_list_names_what_can_be_chosen(capfd: pytest.CaptureFixture[str]) -> None:
    assert bringup.main(['--list']) == 0
    listed, options = capfd.readouterr().out.split('\n\n', 1)
    choices = dict(line.split(':', 1) for line in listed.replace('\n  ', ' ').splitlines())
    assert {'pi', 'ls8', 'hinf1'} <= set(choices['controllers'].replace(',', ' ').split())
    assert 'detailed' in choices['architectures']
    assert 'thesis' in choices['scenarios']
    natural_frequency = next(line for line in options.splitlines() if 'natural_freq' in line)
    assert natural_frequency.split()[1:3] == ['lqi', '4']


@pytest.mark.parametrize('option', ['--help', '--version'])
def test_help_and_version_end_with_code_0(capsys: pytest.CaptureFixture[str], option: str) -> None:
    with pytest.raises(SystemExit) as end:
        bringup.main([option])
    printed = capsys.readouterr()
    assert (end.value.code, printed.err) == (0, '')
    assert printed.out.strip()
