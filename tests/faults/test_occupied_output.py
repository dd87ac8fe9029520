# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Output folders: files of a user are never changed, an old result only by a complete new one."""

import os
import stat
from pathlib import Path

import pytest
from support.complaints import assert_one_line
from support.third_party import install

from ddct_bringup.programs import bringup
from ddct_bringup.run.output_folder import MARKER

SHORT = ['--headless', '--duration', '0.7']


def _run(out: Path, *options: str) -> int:
    return bringup.main([*options, '--out', str(out)])


def _snapshot(folder: Path) -> dict[str, bytes]:
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob('*'))
        if path.is_file()
    }


@pytest.mark.parametrize('overwrite', [[], ['--overwrite']], ids=['plain', 'overwrite'])
@pytest.mark.parametrize('place', ['', 'pi', 'pi.partial'])
def test_a_folder_with_other_files_is_never_touched(
    capfd: pytest.CaptureFixture[str], tmp_path: Path, place: str, overwrite: list[str]
) -> None:
    out = tmp_path / 'runs'
    if place:
        assert _run(out, '--controller', 'ls8', *SHORT) == 0
    foreign = out / place
    foreign.mkdir(parents=True)
    (foreign / 'thesis.txt').write_text('three years of work', encoding='utf-8')
    before = _snapshot(tmp_path)
    capfd.readouterr()
    assert _run(out, *SHORT, *overwrite) == 1
    assert_one_line(capfd.readouterr().err, 'bringup', str(foreign), 'not ours')
    assert _snapshot(tmp_path) == before


@pytest.mark.parametrize('overwrite', [[], ['--overwrite']], ids=['plain', 'overwrite'])
def test_a_file_or_link_in_the_place_of_the_folder_is_never_touched(
    capfd: pytest.CaptureFixture[str], tmp_path: Path, overwrite: list[str]
) -> None:
    file, folder, link = tmp_path / 'file', tmp_path / 'folder', tmp_path / 'link'
    file.write_text('mine', encoding='utf-8')
    folder.mkdir()
    link.symlink_to(folder)
    for out, words in ((file, 'not a folder'), (link, 'symbolic link')):
        assert _run(out, *SHORT, *overwrite) == 1
        assert_one_line(capfd.readouterr().err, 'bringup', str(out), words)
    assert file.read_text(encoding='utf-8') == 'mine'
    assert link.is_symlink()
    assert not any(folder.iterdir())


@pytest.mark.parametrize('overwrite', [[], ['--overwrite']], ids=['plain', 'overwrite'])
@pytest.mark.parametrize('place', ['', 'pi', 'pi.partial'])
def test_nothing_is_written_through_a_marker_that_is_a_link(
    capfd: pytest.CaptureFixture[str], tmp_path: Path, place: str, overwrite: list[str]
) -> None:
    mine, out = tmp_path / 'mine', tmp_path / 'runs'
    mine.write_text('three years of work', encoding='utf-8')
    (out / place).mkdir(parents=True)
    (out / MARKER).touch()
    (out / place / MARKER).unlink(missing_ok=True)
    (out / place / MARKER).symlink_to(mine)
    assert _run(out, *SHORT, *overwrite) == 1
    assert_one_line(capfd.readouterr().err, 'bringup', str(out / place), 'not ours')
    assert mine.read_text(encoding='utf-8') == 'three years of work'
    assert (out / place / MARKER).is_symlink()


def test_a_marker_that_is_there_is_not_written_again(tmp_path: Path) -> None:
    """It may be a second name of another file."""
    mine, out = tmp_path / 'mine', tmp_path / 'runs'
    mine.write_text('three years of work', encoding='utf-8')
    out.mkdir()
    (out / MARKER).hardlink_to(mine)
    assert _run(out, *SHORT) == 0
    assert mine.read_text(encoding='utf-8') == 'three years of work'


def test_an_earlier_result_stays_without_overwrite(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    out = tmp_path / 'runs'
    assert _run(out, *SHORT) == 0
    before = _snapshot(out)
    capfd.readouterr()
    assert _run(out, *SHORT) == 1
    assert_one_line(capfd.readouterr().err, 'bringup', str(out / 'pi'), '--overwrite')
    assert _snapshot(out) == before


def test_overwrite_replaces_the_result_and_leaves_its_neighbours(tmp_path: Path) -> None:
    out = tmp_path / 'runs'
    assert _run(out, *SHORT) == 0
    old = _snapshot(out / 'pi')
    (out / 'pi').rename(out / 'pi.old')
    assert _run(out, *SHORT) == 0
    (out / 'notes.txt').write_text('mine', encoding='utf-8')
    assert _run(out, '--wear-gain', '0.7', *SHORT, '--overwrite') == 0
    assert _snapshot(out / 'pi.old') == old, 'a copy that the user kept'
    assert (out / 'notes.txt').read_text(encoding='utf-8') == 'mine'
    assert _snapshot(out / 'pi')['pi_0.mcap'] != old['pi_0.mcap']
    assert sorted(path.name for path in out.iterdir()) == [
        '.ddct-output',
        'notes.txt',
        'pi',
        'pi.old',
    ]


def test_a_failed_run_keeps_the_earlier_result(
    capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    targets = {'fragile': 'support.broken_controllers:make_not_a_number'}
    install(monkeypatch, tmp_path / 'site', Path(__file__).parent.parent, targets)
    out = tmp_path / 'runs'
    fragile = ['--controller', 'fragile', '--duration', '0.8']
    good = ['--headless', '--set', 'controllers.fragile.good_until_step=1000']
    assert _run(out, *fragile, *good) == 0
    before = _snapshot(out / 'fragile')
    capfd.readouterr()
    assert _run(out, *fragile, '--single-process', '--overwrite') == 1
    assert_one_line(capfd.readouterr().err, 'bringup', 'step 60 is nan')
    assert _snapshot(out / 'fragile') == before
    assert (out / 'fragile.partial' / 'fragile_0.mcap').is_file(), 'what it recorded is kept'
    assert _run(out, *fragile, *good, '--overwrite') == 0
    assert not (out / 'fragile.partial').exists()


def test_a_partial_result_is_named_and_kept_until_overwrite(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    out = tmp_path / 'runs'
    assert _run(out, *SHORT) == 0
    (out / 'pi').rename(out / 'pi.partial')
    before = _snapshot(out)
    capfd.readouterr()
    assert _run(out, *SHORT) == 1
    assert_one_line(capfd.readouterr().err, 'bringup', 'pi.partial', '--overwrite')
    assert _snapshot(out) == before
    assert _run(out, *SHORT, '--overwrite') == 0
    assert not (out / 'pi.partial').exists()


def test_a_failed_start_that_recorded_nothing_is_not_in_the_way(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    out = tmp_path / 'runs'
    with monkeypatch.context() as broken:
        broken.setenv('ROS_DOMAIN_ID', 'abc')
        assert _run(out, '--single-process', '--duration', '0.7') == 1
    assert _run(out, *SHORT) == 0


def test_an_output_below_a_file_is_refused(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    (tmp_path / 'file').write_text('mine', encoding='utf-8')
    assert _run(tmp_path / 'file' / 'runs', *SHORT) == 1
    assert_one_line(capfd.readouterr().err, 'bringup', str(tmp_path / 'file' / 'runs'))


def test_an_unwritable_output_is_refused(
    capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    locked = tmp_path / 'locked'
    locked.mkdir()
    locked.chmod(stat.S_IRUSR | stat.S_IXUSR)
    # Root may write there, but nobody can make a folder in sysfs.
    out = (Path('/sys') if os.access(locked, os.W_OK) else locked) / 'runs'
    assert _run(out, *SHORT) == 1
    assert_one_line(capfd.readouterr().err, 'bringup', str(out), 'cannot be written')
