# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""One folder, two programs: the second is refused by name, whatever it would write there."""

import signal
from collections.abc import Callable
from pathlib import Path

import pytest
from refusals import refused
from support.complaints import assert_one_line
from support.processes import Programs
from waiting import wait_until

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.programs import bringup, compare, report, score
from ddct_bringup.run.output_folder import MARKER, SUFFIX, locked_folders
from ddct_plant.base.errors import DdctError

SHORT = ['--headless', '--duration', '0.7']
PI = ['--controllers', 'pi', *SHORT]
Main = Callable[[list[str]], int]


@pytest.fixture(scope='module')
def compared(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder of runs."""
    out = tmp_path_factory.mktemp('shared') / 'runs'
    assert bringup.main([*SHORT, '--out', str(out)]) == 0
    return out


def _files(folder: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in sorted(folder.rglob('*')) if path.is_file()}


def test_a_second_compare_is_refused_while_the_first_one_lives(
    compared: Path, programs: Programs, capfd: pytest.CaptureFixture[str]
) -> None:
    again = ['--controllers', 'pi', '--headless', '--overwrite', '--out', str(compared)]
    first = programs.fork('ddct_bringup.programs.compare', *again, '--duration', '3600')
    marker = compared.with_name('runs.partial') / 'pi' / MARKER
    # From its marker on, which is made empty, the run writes nothing until it ends.
    wait_until(lambda: marker.exists() and marker.read_bytes() != b'', 'a compare under way')
    before = _files(compared.parent)
    assert compare.main([*again, *SHORT, '--wear-gain', '0.7']) == 1
    words = ('ddct compare', f'{compared}: process {first.process.pid} is writing there')
    assert_one_line(capfd.readouterr().err, *words)
    assert _files(compared.parent) == before
    first.send(signal.SIGKILL)
    first.wait()
    assert compare.main([*again, *SHORT]) == 0, 'the lock must die with its process'
    assert read_bag(compared / 'pi').facts.wear_gain == 1.0
    assert [path.name for path in compared.parent.iterdir()] == ['runs']


@pytest.mark.parametrize(
    ('main', 'arguments'),
    [
        (compare.main, [*PI, '--overwrite', '--out', '']),
        (bringup.main, [*SHORT, '--overwrite', '--out', '']),
        (bringup.main, [*SHORT, '--controller', 'ls8', '--out', '']),
        (report.main, ['', '--out', 'report.html']),
        (score.main, ['', '--json', 'scores.json']),
        (score.main, ['', '--csv', 'scores.csv']),
    ],
    ids=lambda value: ' '.join(value) if isinstance(value, list) else value.__module__[13:],
)
def test_no_program_writes_into_the_folder_of_a_running_compare(
    compared: Path, capfd: pytest.CaptureFixture[str], main: Main, arguments: list[str]
) -> None:
    paths = {'', 'report.html', 'scores.json', 'scores.csv'}
    given = [str(compared / each) if each in paths else each for each in arguments]
    with locked_folders(compared):
        before = _files(compared.parent)
        assert main(given) == 1
        assert 'is writing there' in capfd.readouterr().err
        assert _files(compared.parent) == before


def test_a_folder_below_keeps_the_one_around_it(
    compared: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    with locked_folders(compared / 'pi'):
        assert compare.main([*PI, '--overwrite', '--out', str(compared)]) == 1
    assert_one_line(capfd.readouterr().err, 'ddct compare', f'{compared}: process')


def test_neighbours_share_the_folder_around_them(compared: Path) -> None:
    with locked_folders(compared / 'pi'):
        arguments = ['--controller', 'ls1', *SHORT, '--out', str(compared)]
        assert bringup.main(arguments) == 0
        with (
            pytest.raises(DdctError, match='is writing there'),
            locked_folders(compared / 'pi.partial'),
        ):
            pass


@pytest.mark.parametrize('spelling', ['runs/../runs', 'link/runs', 'runs/'])
def test_one_folder_spelt_in_two_ways_is_one(tmp_path: Path, spelling: str) -> None:
    (tmp_path / 'link').symlink_to(tmp_path)
    (tmp_path / 'runs').mkdir()
    with locked_folders(tmp_path / 'runs'):
        with (
            refused(DdctError, place='runs'),
            locked_folders(tmp_path / spelling),
        ):
            pass
        assert (tmp_path / f'.runs{SUFFIX}').exists()
    assert not (tmp_path / f'.runs{SUFFIX}').exists()
