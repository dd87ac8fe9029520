# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A clone with an environment of its own, in which a mutation is written and tests run."""

import os
import signal
import subprocess
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from mutation.operators import Mutation
from mutation.plugin import ORDER, PROGRESS
from mutation.tracing import FOLDER, SOURCE

TOOLS = Path(__file__).resolve().parents[1]
_END_S = 10.0
"""Timeout for the end of the tests after Ctrl-C, s."""
_NO_TESTS = 5
"""Exit code of pytest that says nothing about a mutation."""
_TRACING = (
    'import os, sys; os.environ.get({folder!r}) and (sys.path.append({tools!r}), '
    "__import__('mutation.tracing', fromlist=['start']).start())\n"
)
"""Line of a `.pth` file: Python runs it at the start of each process of the environment."""


class Ended(NamedTuple):
    """How a run of tests ended."""

    state: str
    """`passed`, `failed` or `late`."""
    test: str
    """The test that failed or was running; empty outside of a test."""
    running_s: float = 0.0
    """Since when a late test was running, s."""


class ScratchCopy:
    """One clone; only one mutation is in it at a time."""

    def __init__(self, root: Path) -> None:
        """Take a clone in which `make setup` and the optional packages' targets have run."""
        self.root = root.resolve()
        self._writes = 0

    @classmethod
    def make(cls, repository: Path, commit: str, root: Path) -> 'ScratchCopy':
        """Clone a commit and prepare the environment, minutes."""
        subprocess.run(['git', 'clone', '--quiet', repository, root], check=True)
        subprocess.run(['git', '-C', root, 'checkout', '--quiet', commit], check=True)
        wanted = ['setup', 'EXTRAS=fmu,gym,tune,site,test']
        subprocess.run(['make', '-C', root, *wanted], check=True, stdout=subprocess.DEVNULL)
        return cls(root)

    @contextmanager
    def mutated(self, mutation: Mutation) -> Iterator[None]:
        """Have the mutation in the copy for a while."""
        path = self.root / mutation.file
        before, times = path.read_bytes(), path.stat()
        self._writes += 1
        mutation.apply(self.root)
        # Bytecode is told by second and size, and a mutation may have both of the text before.
        later_s = times.st_mtime + self._writes
        os.utime(path, (later_s, later_s))
        try:
            yield
        finally:
            path.write_bytes(before)
            os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))

    def run(self, tests: Sequence[str], limit_s: float) -> Ended:
        """Run tests in the given order until one fails or the time is over."""
        order, progress = (self.root / name for name in ('.mutation_order', '.mutation_progress'))
        order.write_text('\n'.join(tests) + '\n', encoding='utf-8')
        progress.write_text('', encoding='utf-8')
        files = list(dict.fromkeys(test.partition('::')[0] for test in tests))
        process = self._start(['-x', '--tb=no', *files], {ORDER: order, PROGRESS: progress})
        try:
            process.communicate(timeout=limit_s)
        except subprocess.TimeoutExpired:
            running_s = time.time() - progress.stat().st_mtime
            self._end(process)
            return Ended('late', progress.read_text(encoding='utf-8'), running_s)
        if process.returncode == _NO_TESTS:
            raise RuntimeError(f'pytest in {self.root} finds none of {tests[:3]}')
        if process.returncode == 0:
            return Ended('passed', '')
        return Ended('failed', progress.read_text(encoding='utf-8'))

    def record(self, records: Path, arguments: Sequence[str]) -> int:
        """Run pytest with `arguments`, record which lines each test runs; return the exit code."""
        records.mkdir(parents=True)
        [packages] = (self.root / '.venv/lib').glob('python*/site-packages')
        tracing = packages / 'ddct_tracing.pth'
        tracing.write_text(_TRACING.format(folder=FOLDER, tools=str(TOOLS)), encoding='utf-8')
        try:
            return self._start(arguments, {FOLDER: records, SOURCE: self.root}).wait()
        finally:
            tracing.unlink()

    def _start(
        self, arguments: Sequence[str], variables: dict[str, Path]
    ) -> subprocess.Popen[bytes]:
        command = ['.venv/bin/python', '-m', 'pytest', '-q', '-p', 'no:cacheprovider']
        script = f'. install/setup.bash; export PYTHONPATH="{TOOLS}:$PYTHONPATH"; exec "$@"'
        return subprocess.Popen(
            ['bash', '-c', script, 'bash', *command, '-p', 'mutation.plugin', *arguments],
            cwd=self.root,
            env={**_environment(), **{name: str(path) for name, path in variables.items()}},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )

    @staticmethod
    def _end(process: subprocess.Popen[bytes]) -> None:
        """End the tests as Ctrl-C would, so that fixtures stop what they have started."""
        for number in (signal.SIGINT, signal.SIGKILL):
            os.killpg(process.pid, number)
            try:
                process.wait(_END_S)
                return
            except subprocess.TimeoutExpired:
                continue


def _environment() -> dict[str, str]:
    """Return the environment without what another workspace has put in."""
    # The ROS wheels find their libraries by these, once in a chain of processes.
    ros = ('AMENT_', 'COLCON_', 'RMW_', 'ROS_', '_ROS_', 'CMAKE_PREFIX_PATH', 'LD_LIBRARY_PATH')
    left_out = (*ros, 'PYTHON', 'VIRTUAL_ENV')
    kept = {name: value for name, value in os.environ.items() if not name.startswith(left_out)}
    return {**kept, 'OPENBLAS_NUM_THREADS': '1'}
