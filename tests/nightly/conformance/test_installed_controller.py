# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The package of `ddct check --new` is installed by the printed commands, and its tests pass."""

import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from waiting import WITHIN_S

from ddct_controllers.check import program as check


def python(site: Path, code: str) -> str:
    """
    Return the output of Python where the packages in `site` are installed.

    The folder of the package is in the current one, which Python searches first.
    """
    done = subprocess.run(
        [sys.executable, '-c', f'import site; site.addsitedir({str(site)!r})\n{code}'],
        cwd=site.parent,
        capture_output=True,
        text=True,
        timeout=3 * WITHIN_S,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_the_printed_commands_install_check_and_run_the_package_and_its_tests_pass(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    folder, site = tmp_path / 'my own slip', tmp_path / 'site'
    assert check.main(['--new', 'my_slip', '--out', str(folder)]) == 0
    *_, command, tried, compare = capfd.readouterr().out.splitlines()
    readme = (folder / 'README.md').read_text(encoding='utf-8')
    assert f'    {command.strip()}\n' in readme
    assert f"-m pytest '{folder}'`" in readme
    subprocess.run(
        [*shlex.split(command), '--target', str(site)],
        capture_output=True,
        timeout=3 * WITHIN_S,
        check=True,
    )
    for line in (tried, compare):
        words = f'import sys\nsys.argv = {shlex.split(line)!r}\n'
        python(site, f'{words}from ddct_bringup.programs.ddct import main\nassert not main()')
    assert list(tmp_path.glob('runs/my_slip/my_slip/*.mcap'))
    listing = "from ddct_bringup.programs.bringup import main\nmain(['--list'])"
    assert 'least_jerk, my_slip' in ' '.join(python(site, listing).split())
    tests = f'import pytest\nassert pytest.main(["-q", {str(folder)!r}, "-p", "no:cacheprovider"])'
    assert '3 passed' in python(site, f'{tests} == 0')
