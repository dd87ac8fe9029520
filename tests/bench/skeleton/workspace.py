# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Built workspaces of any version, and programs in their environment, none of them left behind."""

import os
import re
import resource
import signal
import subprocess
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import IO

from bench.skeleton.interruption import uninterrupted

ROOT = Path(__file__).resolve().parents[3]
END_S = 20.0
"""Time in s after SIGTERM before a program is killed."""
_OTHER_WORKSPACE = re.compile(
    r'(AMENT_|COLCON_|RMW_|ROS_|_ROS_|MAKE)\w*|MFLAGS|CMAKE_PREFIX_PATH|LD_LIBRARY_PATH'
    r'|PYTHON(DONTWRITEBYTECODE|HOME|PATH)|VIRTUAL_ENV|PS1'
)
"""Names of inherited variables that belong to this workspace or to the make that runs us."""


class ProgramError(Exception):
    """A program did not end well; the text has its command and the end of its output."""


@dataclass(frozen=True)
class Cost:
    """What a program printed, and what it took."""

    output: str
    wall_s: float
    processor_s: float
    """Processor time of all its processes that have ended, s."""


@dataclass(frozen=True)
class Workspace:
    """Folder of a built workspace."""

    folder: Path

    @cached_property
    def environment(self) -> Mapping[str, str]:
        """Environment variables after its set-up script."""
        source = ['sh', '-c', '. install/setup.sh && env -0']
        done = subprocess.run(
            source, cwd=self.folder, env=clean_environment(), check=True, stdout=subprocess.PIPE
        )
        entries = (entry.partition('=') for entry in done.stdout.decode().split('\0') if entry)
        return {name: value for name, _, value in entries} | {'OPENBLAS_NUM_THREADS': '1'}

    def run(self, program: str, *arguments: object) -> Cost:
        """Run a program of its environment; raise ProgramError when it does not end well."""
        found = self.folder / '.venv' / 'bin' / program
        command = [str(found if found.exists() else program), *map(str, arguments)]
        before, started = _children_s(), time.monotonic()
        output = run_to_end(command, self.folder, self.environment)
        return Cost(output, time.monotonic() - started, _children_s() - before)


def clean_environment() -> dict[str, str]:
    """Return our environment without what another workspace or make must not inherit."""
    return {key: text for key, text in os.environ.items() if not _OTHER_WORKSPACE.fullmatch(key)}


def run_to_end(command: list[str], folder: Path, environment: Mapping[str, str]) -> str:
    """
    Return the standard output of a program; raise ProgramError when it does not end well.

    Where we are interrupted, the program and all its children are ended first.
    """
    with tempfile.TemporaryFile() as output, tempfile.TemporaryFile() as errors:
        with started(command, folder, environment, output, errors) as process:
            code = process.wait()
        if code:
            last = _text(errors).strip().rpartition('\n')[2]
            raise ProgramError(f'{" ".join(command)} ended with code {code}: {last}')
        return _text(output)


@contextmanager
def started(
    command: list[str],
    folder: Path,
    environment: Mapping[str, str],
    output: IO[bytes],
    errors: IO[bytes],
) -> Iterator[subprocess.Popen[bytes]]:
    """Start a program in a process group of its own, and end the group where it still runs."""
    process = None
    try:
        with uninterrupted():
            process = subprocess.Popen(
                command,
                cwd=folder,
                env=dict(environment),
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=errors,
                start_new_session=True,
            )
        yield process
    finally:
        if process:
            _end_group(process)


def _end_group(process: subprocess.Popen[bytes]) -> None:
    """End the processes of a group, by SIGTERM first, so that programs stop what they started."""
    if process.poll() is None:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGTERM)
        with suppress(subprocess.TimeoutExpired):
            process.wait(END_S)
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def _text(file: IO[bytes]) -> str:
    file.seek(0)
    return file.read().decode(errors='replace')


def _children_s() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime
