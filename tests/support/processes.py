# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Programs as processes of their own, and the processes that a test leaves (Linux /proc)."""

import contextlib
import os
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ddct_bringup.processes.forked_process import ForkedProcess
from ddct_bringup.processes.graph_nodes import NodeSpec
from ddct_bringup.processes.jobs import Job
from support.shared_parent import TEST_ID, is_shared, shared_parent
from support.waiting import WITHIN_S, wait_until

_before: set[int] = set()
"""Ids of the processes that were there before this test."""


@dataclass
class Program:
    """Running program and the files of its output."""

    process: subprocess.Popen[bytes] | ForkedProcess
    stdout: Path
    stderr: Path

    def send(self, number: signal.Signals) -> None:
        """Send it a signal."""
        self.process.send_signal(number)

    def wait(self, within_s: float = WITHIN_S) -> int:
        """Wait for its end and return the exit code, which is -n after signal n."""
        return self.process.wait(within_s)

    def stop(self) -> None:
        """Stop it as Ctrl-C in its terminal would and require that it ends with code 0."""
        os.killpg(self.process.pid, signal.SIGINT)
        code = self.wait()
        assert code == 0, f'{self.process.pid}: code {code} after SIGINT: {self.errors()}'

    def output(self) -> str:
        """Return its standard output so far."""
        return self.stdout.read_text(encoding='utf-8')

    def errors(self) -> str:
        """Return its standard error so far."""
        return self.stderr.read_text(encoding='utf-8')


class Programs:
    """Starter of programs that kills those still running after a failed test."""

    def __init__(self, logs: Path) -> None:
        """Write the output of the programs into `logs`."""
        self._logs = logs
        self._started: list[Program] = []

    def start(self, command: Sequence[str], **options: Any) -> Program:
        """Start a command; `options` are those of Popen."""
        out, err = self._log('out'), self._log('err')
        with out.open('wb') as stdout, err.open('wb') as stderr:
            process = subprocess.Popen(
                list(command),
                stdin=subprocess.DEVNULL,
                stdout=stdout,
                stderr=stderr,
                start_new_session=True,
                **options,
            )
        return self._add(Program(process, out, err))

    def fork(self, module: str, *arguments: str) -> Program:
        """
        Start `main` of a module as a fork of the warm parent of all tests: without its imports.

        Both streams of output are in one file. It differs in nothing else from `start_module`,
        which takes its place where a fork is not possible.
        """
        parent = shared_parent()
        if parent is None:
            return self.start_module(module, *arguments)
        printed = self._log('out')
        with printed.open('wb') as output:
            (process,) = parent.start([Job(module, arguments, output=output.fileno())])
        return self._add(Program(process, printed, printed))

    def start_module(self, module: str, *arguments: str, **options: Any) -> Program:
        """Start `python -m module` with the Python that runs the tests."""
        return self.start([sys.executable, '-m', module, *arguments], **options)

    def start_node(self, module: str, parameters: Mapping[str, object]) -> Program:
        """Start a node by hand, with these ROS parameters."""
        return self.fork(module, *ros_arguments(parameters))

    def _log(self, suffix: str) -> Path:
        self._logs.mkdir(exist_ok=True)
        return self._logs / f'{len(self._started)}.{suffix}'

    def _add(self, program: Program) -> Program:
        self._started.append(program)
        return program

    def kill(self) -> None:
        """Kill and reap the programs that still run."""
        for program in self._started:
            if program.process.poll() is None:
                program.send(signal.SIGKILL)
            program.wait()


def package_of(node: NodeSpec) -> str:
    """Return the package whose program the node is."""
    return node.module.partition('.')[0]


def ros_arguments(parameters: Mapping[str, object]) -> list[str]:
    """Return the command-line arguments that set ROS parameters."""
    arguments = ['--ros-args']
    for name, value in parameters.items():
        text = str(value).lower() if isinstance(value, bool) else str(value)
        arguments += ['-p', f'{name}:={text}']
    return arguments


def note_processes() -> None:
    """Note the processes that are there before a test: it has started none of them."""
    _before.clear()
    _before.update(_all_processes())


def _all_processes() -> list[int]:
    return [int(each.name) for each in Path('/proc').iterdir() if each.name.isdigit()]


def processes_left() -> dict[int, str]:
    """Return the command line by id of every other process that this test has started."""
    mark = f'{TEST_ID}={os.environ[TEST_ID]}'.encode()
    left = {}
    for pid in _all_processes():
        if pid in _before or pid == os.getpid() or is_shared(pid):
            continue
        folder = Path(f'/proc/{pid}')
        # A process may end, or belong to another user, during the scan.
        with contextlib.suppress(OSError):
            command = (folder / 'cmdline').read_bytes().replace(b'\0', b' ').decode().strip()
            marked = mark in (folder / 'environ').read_bytes().split(b'\0')
            # A fork of the shared parent has the variables that this one had at its start.
            if marked or ('ddct_' in command and _parent_of(pid) == os.getpid()):
                left[pid] = command
    return left


def _parent_of(pid: int) -> int:
    """Return the id of a process's parent; raise OSError where the process has ended."""
    status = Path(f'/proc/{pid}/stat').read_text(encoding='utf-8')
    return int(status.rpartition(')')[2].split()[1])


def children_of(parent: int) -> list[int]:
    """Return the process ids of the processes that this test has started by way of another."""
    found = []
    for pid in processes_left():
        with contextlib.suppress(OSError):
            if _parent_of(pid) == parent:
                found.append(pid)
    return found


def node_of(module: str) -> int:
    """Return the process id of the node of this test that runs `module`, once it is there."""
    found: list[int] = []

    def find() -> bool:
        found[:] = [pid for pid, command in processes_left().items() if module in command]
        return bool(found)

    wait_until(find, f'a process of {module}')
    assert len(found) == 1, f'{module} runs {len(found)} times'
    return found[0]
