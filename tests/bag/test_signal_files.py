# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`score` writes signals for other tools: the same numbers as CSV and MAT, a file for each bag."""

import errno
import os
from pathlib import Path

import numpy as np
import pytest

from ddct_bringup.programs.score import main
from ddct_bringup.run.headless import run_headless
from ddct_bringup.scores.csv_text import signal_columns
from ddct_bringup.scores.signal_files import signal_file_stems
from ddct_plant.files import output_file
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings
from ddct_plant.signals.topics import all_signals

MOST_LETTERS = 63
"""Longest name of a variable in MATLAB: letters, digits and underscores, a letter first."""
KEYWORDS = ('break', 'case', 'catch', 'end', 'for', 'function', 'global', 'if', 'return', 'while')


def test_signals_come_as_mat_to_the_last_bit_under_the_names_of_the_csv(
    bags, trajectory, tmp_path
):
    from scipy.io import loadmat

    bags.write(trajectory, folder='demo/pi')
    folders = ['--signals-mat', str(tmp_path / 'out'), '--signals-csv', str(tmp_path / 'out')]
    assert main([str(tmp_path / 'demo'), *folders]) == 0
    written = loadmat(tmp_path / 'out' / 'pi.mat')
    found = {name: each for name, each in written.items() if not name.startswith('__')}
    wanted = signal_columns(trajectory)
    header = (tmp_path / 'out' / 'pi.csv').read_text().partition('\n')[0]
    assert list(found) == list(wanted) == header.split(',')
    for name, values in wanted.items():
        assert found[name].shape == (trajectory.steps + 1, 1)
        np.testing.assert_array_equal(found[name][:, 0], values)


def test_the_same_run_gives_the_same_bytes(bags, trajectory, tmp_path):
    bag = str(bags.write(trajectory))
    for name in ('first', 'second'):
        assert main([bag, '--signals-mat', str(tmp_path / name)]) == 0
    first, second = (next((tmp_path / name).iterdir()) for name in ('first', 'second'))
    assert first.read_bytes() == second.read_bytes()
    assert b'Created on' not in first.read_bytes()[:128]


def test_the_text_of_a_mat_file_leaves_the_eight_bytes_after_it_empty(bags, trajectory, tmp_path):
    """Bytes 117 to 124 of a MAT file of version 5 are the place of further data: zero is none."""
    assert main([str(bags.write(trajectory)), '--signals-mat', str(tmp_path / 'mat')]) == 0
    content = next((tmp_path / 'mat').iterdir()).read_bytes()
    assert content[:116].rstrip() == b'MATLAB 5.0 MAT-file, written by ddct score'
    assert content[116:124] == bytes(8)


def test_every_signal_has_a_name_that_matlab_takes():
    scenario = load_scenario('launch', {'sensors.engine_speed.noise_rad_s': 0.1})
    settings = RunSettings(KnownSettings(scenario))
    columns = signal_columns(run_headless(settings, 'mpc4'))
    names = {*columns, *(signal.column for signal in all_signals())}
    assert len(columns) > 20
    for name in names:
        assert name.isidentifier() and name.isascii() and name[0].isalpha(), name
        assert len(name) <= MOST_LETTERS and name not in KEYWORDS, name


def test_bags_of_one_name_in_two_folders_have_two_files(bags, trajectory, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    bags.write(trajectory, folder='new/pi')
    bags.write(trajectory, folder='worn/pi')
    bags.write(trajectory, folder='worn/ls8')
    assert main(['new', 'worn', '--signals-csv', 'csv', '--signals-mat', 'mat']) == 0
    for ending in ('csv', 'mat'):
        files = sorted(file.name for file in (tmp_path / ending).iterdir())
        assert files == [f'ls8.{ending}', f'new_pi.{ending}', f'worn_pi.{ending}']


def test_two_bags_that_would_share_a_file_are_refused_before_any_is_written(
    bags, trajectory, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    bags.write(trajectory, folder='a/pi')
    bags.write(trajectory, folder='a_pi')
    assert main(['a/pi', 'a_pi', '--signals-mat', 'mat']) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert 'a/pi and a_pi: the signals of both would be in a_pi' in line
    assert not (tmp_path / 'mat').exists()


@pytest.mark.parametrize('given', ['.', './'])
def test_a_bag_that_is_the_working_directory_gives_its_name(tmp_path, monkeypatch, given):
    folder = tmp_path / 'pi'
    folder.mkdir()
    monkeypatch.chdir(folder)
    assert list(signal_file_stems([(Path(given), None)]).values()) == ['pi']


def test_a_full_disk_is_named_and_no_fault_of_the_bag(
    bags, trajectory, tmp_path, monkeypatch, capsys
):
    bag = str(bags.write(trajectory))

    def full(path: Path, content: bytes) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))

    monkeypatch.setattr(output_file, '_replace', full)
    assert main([bag, '--signals-csv', str(tmp_path / 'csv')]) == 1
    found = capsys.readouterr()
    (line,) = found.err.splitlines()
    assert 'No space left on device' in line
    assert 'csv' in line
    assert found.out == '', 'a table with a bag that is not valid'
