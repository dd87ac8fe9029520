# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Wheels in an empty environment without ROS: the example of the README, a run, typed use."""

import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from release.build import ROOT, ReleaseError, run

TYPED = """\
from ddct_bringup.api import Command, Controller, ControllerContext, Measurement, run


class Proportional(Controller):
    def __init__(self, context: ControllerContext) -> None:
        self.gain = -0.1

    def reset(self) -> None:
        pass

    def update(self, measurement: Measurement) -> Command:
        return Command(self.gain * measurement.slip_error_rpm)


mine = run(Proportional, wear_gain=0.9)
state: str = mine.state
time_s = mine.metrics['engagement_time_s']
print(state, time_s)
"""
"""Use of the Python interface with types, for `mypy --strict`."""


ROWS = """\
from ddct_bringup.benchmark.cases import packaged_folder
from ddct_bringup.benchmark.release import release_rows
from ddct_bringup.manifest.origin import CodeOrigin

print(release_rows(packaged_folder()).other_code(CodeOrigin.here()) or 'computed by this code')
"""
"""Program that says whether the code of a release is that which computed its rows."""


def try_wheels(wheels: Sequence[Path], folder: Path) -> Iterator[str]:
    """
    Install wheels into a new environment in a folder, and use them; yield a line for each use.

    The versions of what they need are those of locks/workspace.txt. Raise ReleaseError with the
    output of the first use that fails.
    """
    folder.mkdir(parents=True)
    python = folder / 'venv' / 'bin' / 'python'
    uv = Path(sys.executable).with_name('uv')
    run(uv, 'venv', '--quiet', '--python', sys.executable, folder / 'venv')
    constraints = _versions(folder / 'constraints.txt')
    install = (uv, 'pip', 'install', '--quiet', '--python', python)
    run(*install, '--constraint', constraints, *wheels, cwd=folder)
    yield f'installed without ROS: {", ".join(wheel.name for wheel in wheels)}'
    (folder / 'mine.py').write_text(example_of_readme(), encoding='utf-8')
    yield f"the README's example: {run(python, 'mine.py', cwd=folder).strip()}"
    ddct = python.with_name('ddct')
    run(ddct, 'compare', '--headless', '--controllers', 'pi,ls8', '--out', 'runs', cwd=folder)
    yield f'ddct compare --headless: {len(list(folder.glob("runs/*/*.mcap")))} bags'
    run(python, '-m', 'ddct_bringup.schemas', 'schemas', cwd=folder)
    yield f'schemas of its JSON: {len(list(folder.glob("schemas/*.schema.json")))}'
    yield f'rows of the benchmark: {run(python, "-c", ROWS, cwd=folder).strip()}'
    (folder / 'typed.py').write_text(TYPED, encoding='utf-8')
    run(*install, '--constraint', constraints, 'mypy', cwd=folder)
    checked = run(python, '-m', 'mypy', '--strict', 'typed.py', cwd=folder)
    yield f'mypy --strict of a program that uses ddct_bringup.api: {checked.strip()}'
    yield f'its output: {run(python, "typed.py", cwd=folder).strip()}'
    _require_no_ros(python, folder)


def example_of_readme() -> str:
    """Return the controller of one's own that the README shows."""
    page = (ROOT / 'README.md').read_text(encoding='utf-8')
    found = re.search(r'```python\n(.*?)```', page, re.DOTALL)
    if found is None:
        raise ReleaseError('README.md has no example in Python')
    return found[1]


def _versions(file: Path) -> Path:
    """Write the versions of locks/workspace.txt, without hashes, and return the file."""
    lines = (ROOT / 'locks' / 'workspace.txt').read_text(encoding='utf-8').splitlines()
    pinned = [line.rstrip(' \\') for line in lines if re.match(r'[a-z0-9]', line)]
    file.write_text('\n'.join(pinned) + '\n', encoding='utf-8')
    return file


def _require_no_ros(python: Path, folder: Path) -> None:
    found = subprocess.run([python, '-c', 'import rclpy'], cwd=folder, capture_output=True)
    if not found.returncode:
        raise ReleaseError('the trial environment has rclpy: it shows nothing about users without')
