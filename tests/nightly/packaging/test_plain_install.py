# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""pip installs the four packages into an environment of its own, where `ddct` starts them."""

import importlib.util
import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest
from waiting import WITHIN_S

from ddct_bringup.programs.ddct import TASKS

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[3]
PACKAGES = ('ddct_plant', 'ddct_reference', 'ddct_controllers', 'ddct_bringup')
IGNORED = shutil.ignore_patterns('test', '__pycache__', '*.egg-info', 'build')


def run(*command: str | Path) -> str:
    environment = {name: value for name, value in os.environ.items() if name != 'PYTHONPATH'}
    done = subprocess.run(
        command, env=environment, capture_output=True, text=True, timeout=3 * WITHIN_S, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope='module')
def prefix(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return an environment with the packages, beside what the tests' own one has installed."""
    if importlib.util.find_spec('pip') is None:
        pytest.skip('no pip in this environment')
    folder = tmp_path_factory.mktemp('plain')
    sources = [shutil.copytree(ROOT / each, folder / each, ignore=IGNORED) for each in PACKAGES]
    run(sys.executable, '-m', 'venv', '--without-pip', folder / 'venv')
    site = sysconfig.get_path('purelib', 'venv', {'base': str(folder / 'venv')})
    (Path(site) / 'outer.pth').write_text(sysconfig.get_path('purelib'))
    pip = (sys.executable, '-m', 'pip', '--python', folder / 'venv' / 'bin' / 'python')
    offline = ('--no-deps', '--no-index', '--no-build-isolation', '--disable-pip-version-check')
    run(*pip, 'install', *offline, *sources)
    return folder / 'venv'


def test_ddct_alone_comes_onto_the_path(prefix: Path, tmp_path: Path) -> None:
    run(sys.executable, '-m', 'venv', '--without-pip', tmp_path / 'venv')
    bare = {file.name for file in (tmp_path / 'venv' / 'bin').iterdir()}
    assert {file.name for file in (prefix / 'bin').iterdir()} - bare == {'ddct'}


def test_ddct_starts_the_programs_of_all_packages(prefix: Path) -> None:
    listed = run(prefix / 'bin' / 'ddct', '--help')
    for task in TASKS:
        assert f'\n{task}:\n' in listed
    assert '  controller  ' in run(prefix / 'bin' / 'ddct', 'node', '--help')
    assert 'thesis' in run(prefix / 'bin' / 'ddct', 'compare', '--list')
    assert run(prefix / 'bin' / 'ddct', 'identify', '--help').startswith('usage: ddct identify ')
