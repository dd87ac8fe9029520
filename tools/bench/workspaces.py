# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Workspaces of this and of another commit, and programs in their environment."""

import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import IO

ROOT = Path(__file__).resolve().parents[2]
END_S = 20.0
"""Time in s after SIGTERM before a program is killed."""
_INHERITED = (
    *('AMENT_', 'COLCON_', 'RMW_', 'ROS_', '_ROS_', 'CMAKE_PREFIX_PATH', 'LD_LIBRARY_PATH'),
    *('MAKE', 'MFLAGS', 'PYTHON', 'VIRTUAL_ENV'),
)
"""Beginnings of the names of variables that belong to another workspace, or to make."""


class ProgramError(Exception):
    """A program did not end well; the text has its command and the end of its output."""


@cache
def environment_of(folder: Path) -> Mapping[str, str]:
    """Return the environment variables after the set-up script of a built workspace."""
    script = ['sh', '-c', '. install/setup.sh && env -0']
    done = subprocess.run(script, cwd=folder, env=_clean(), check=True, stdout=subprocess.PIPE)
    entries = (entry.partition('=') for entry in done.stdout.decode().split('\0') if entry)
    return {name: value for name, _, value in entries} | {'OPENBLAS_NUM_THREADS': '1'}


def run(folder: Path, *command: object) -> str:
    """Return the output of a program in a workspace; raise ProgramError for a bad end."""
    return _to_end(folder, environment_of(folder), *command)


def bringup(folder: Path) -> Path:
    """Return the program of a workspace that runs one controller and leaves its bag alone."""
    return folder / 'install' / 'ddct_bringup' / 'lib' / 'ddct_bringup' / 'bringup'


@contextmanager
def base_workspace(revision: str) -> Iterator[Path]:
    """Check a commit out into a temporary folder, run `make setup` there, remove it at the end."""
    with tempfile.TemporaryDirectory(prefix='ddct-bench-') as place:
        folder = Path(place) / 'base'
        git = ('git', '-C', ROOT, 'worktree')
        _to_end(ROOT, os.environ, *git, 'add', '--quiet', '--detach', folder, revision)
        try:
            print(f'bench: sets up {revision}', file=sys.stderr, flush=True)
            _to_end(folder, _clean(), 'make', 'setup')
            yield folder
        finally:
            _to_end(ROOT, os.environ, *git, 'remove', '--force', folder)


@contextmanager
def started(
    command: list[str], environment: Mapping[str, str], output: IO[bytes], errors: IO[bytes]
) -> Iterator[subprocess.Popen[bytes]]:
    """Start a program in a process group of its own; at the end, end what is left of it."""
    process = subprocess.Popen(
        command,
        cwd=ROOT,
        env=dict(environment),
        stdin=subprocess.DEVNULL,
        stdout=output,
        stderr=errors,
        start_new_session=True,
    )
    try:
        yield process
    finally:
        # SIGTERM first, so that programs stop what they have started.
        if process.poll() is None:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGTERM)
            with suppress(subprocess.TimeoutExpired):
                process.wait(END_S)
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def _to_end(folder: Path, environment: Mapping[str, str], *command: object) -> str:
    words = [str(each) for each in command]
    done = subprocess.run(
        words, cwd=folder, env=dict(environment), capture_output=True, text=True, check=False
    )
    if done.returncode:
        last = done.stderr.strip().rpartition('\n')[2]
        raise ProgramError(f'{" ".join(words)} ended with code {done.returncode}: {last}')
    return done.stdout


def _clean() -> dict[str, str]:
    return {name: text for name, text in os.environ.items() if not name.startswith(_INHERITED)}
