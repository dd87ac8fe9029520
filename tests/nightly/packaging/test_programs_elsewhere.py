# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Longer work where our packages find no more of a system than Windows has, and by pip alone."""

import subprocess
import sys
from pathlib import Path

import pyarrow.parquet as parquet
import pytest
from support.c_controllers import counting, harmful
from support.declared import ROOT
from support.elsewhere import elsewhere, python_elsewhere
from support.short_campaign import write_specification

from ddct_bringup.programs.ddct import main

pytestmark = [pytest.mark.slow, pytest.mark.process]

SCRIPT = 'import sys\nfrom ddct_bringup.programs.ddct import main\nsys.exit(main())\n'
"""A script without `if __name__ == '__main__':`, which no worker may run once more."""


@pytest.fixture(scope='module')
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return elsewhere(tmp_path_factory.mktemp('site'))


def ddct(site: Path, place: Path, command: str) -> 'subprocess.CompletedProcess[str]':
    (place / 'script.py').write_text(SCRIPT, encoding='utf-8')
    return python_elsewhere(site, place, 'script.py', *command.split(), within_s=900.0)


def test_a_controller_in_a_file_gives_the_rows_of_forks(
    site: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_specification(tmp_path)
    done = ddct(site, tmp_path, 'campaign mass.yaml --workers 2 --out anew')
    assert done.returncode == 0, done.stderr
    monkeypatch.chdir(tmp_path)
    assert main(['campaign', 'mass.yaml', '--workers', '2', '--out', 'forked']) == 0
    anew, forked = (parquet.read_table(f'{each}/results.parquet') for each in ('anew', 'forked'))
    assert anew.equals(forked)


@pytest.mark.parametrize(
    'command',
    [
        'benchmark pi --quick --workers 2 --out benchmark',
        'sweep --controllers pi,ls8 --over wear_gain=0.9:1.1:3',
        'thesis numbers',
    ],
)
def test_a_program_ends_well(site: Path, tmp_path: Path, command: str) -> None:
    done = ddct(site, tmp_path, command)
    assert done.returncode == 0, done.stderr


@pytest.mark.compiler
def test_compiled_code_has_a_new_process_whose_end_is_the_reason_of_its_run(
    site: Path, tmp_path: Path
) -> None:
    good, bad = counting(tmp_path), harmful(tmp_path)
    options = '--headless --duration 1 --set controllers.harmful.fault=2 --out runs'
    done = ddct(site, tmp_path, f'compare --controllers {good},{bad} {options}')
    assert done.returncode == 1
    assert 'it crashed (SIGABRT) when update was called at step 65' in done.stderr
    assert (tmp_path / 'runs' / 'counting').is_dir()


def test_pip_installs_what_works_without_ros() -> None:
    if offline():
        pytest.skip('no package index')
    command = [sys.executable, str(ROOT / 'tools' / 'without_ros')]
    done = subprocess.run(command, capture_output=True, text=True, timeout=1800.0, check=False)
    assert done.returncode == 0, done.stderr


def offline() -> bool:
    """Return whether pip finds no package."""
    command = [sys.executable, '-m', 'pip', 'index', 'versions', 'markupsafe']
    return subprocess.run(command, capture_output=True, timeout=60.0, check=False).returncode != 0
