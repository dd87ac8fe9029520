# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A disk that fills up ends a run with a reason, and leaves nothing like a result."""

import os
import resource
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from samples import sampled
from support.complaints import assert_one_line
from support.processes import processes_left

from ddct_bringup.programs import bringup, compare, score
from ddct_bringup.run.output_folder import mark_folder

ROOM_KB = 200
RUN = ('--controller', 'ls8', '--duration', '20')


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """Mount a disk with room for the first steps of a run."""
    disk = tmp_path / 'disk'
    disk.mkdir()
    if os.geteuid() != 0:
        pytest.skip('only root can mount a small disk')
    mount = ['mount', '-t', 'tmpfs', '-o', f'size={ROOM_KB}k', 'tmpfs', str(disk)]
    mounted = subprocess.run(mount, capture_output=True, text=True, check=False)
    if mounted.returncode != 0:
        pytest.skip(f'a small disk cannot be mounted here: {mounted.stderr.strip()}')
    yield disk
    subprocess.run(['umount', str(disk)], check=True)


@pytest.mark.parametrize('layout', sampled([[], ['--headless']], every=2))
def test_a_full_disk_ends_the_run_with_the_file_and_the_reason(
    small_disk: Path, capfd: pytest.CaptureFixture[str], layout: list[str]
) -> None:
    out = small_disk / 'runs'
    assert bringup.main([*RUN, *layout, '--out', str(out)]) == 1
    assert not processes_left()
    errors = capfd.readouterr().err
    assert_one_line(errors, 'bringup', 'No space left on device', 'ls8_0.mcap')
    assert not (out / 'ls8').exists()
    assert score.main([str(out / 'ls8.partial')]) == 1
    assert 'incomplete: ' in ' '.join(capfd.readouterr().out.split())


def test_a_limit_on_the_size_of_files_ends_the_run_with_the_file_and_the_reason(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / 'runs'
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (ROOM_KB * 1024, hard))
    try:
        assert bringup.main([*RUN, '--headless', '--out', str(out)]) == 1
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert_one_line(capfd.readouterr().err, 'bringup', 'File too large', 'ls8_0.mcap')
    assert not (out / 'ls8').exists()


def test_a_compare_whose_disk_fills_up_ends_and_takes_no_old_result_away(
    small_disk: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    out = small_disk / 'runs'
    mark_folder(out)
    (out / 'scores.json').write_text('an old result', encoding='utf-8')
    before = {path: path.read_bytes() for path in out.rglob('*') if path.is_file()}
    arguments = ['--controllers', 'pi,ls8,ls1', '--headless', '--overwrite', '--duration', '1']
    assert compare.main([*arguments, '--out', str(out)]) == 1
    assert (small_disk / 'runs.partial' / 'pi' / 'metadata.yaml').is_file(), 'the first one fits'
    first, last = capfd.readouterr().err.splitlines()[-2:]
    assert first.startswith('ddct compare: ls8: ')
    assert 'No space left on device' in first
    assert last.startswith(f'ddct compare: {small_disk}/runs.partial/ls8/failed_run.json: ')
    assert 'No space left on device' in last
    assert not (small_disk / 'runs.partial' / 'ls1').exists(), 'it would fare no better'
    assert {path: path.read_bytes() for path in out.rglob('*') if path.is_file()} == before
