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

from waiting import WITHIN_S, wait_until

from ddct_bringup.processes.fork_server import server_pid, start_processes
from ddct_bringup.processes.forked import Forked
from ddct_bringup.processes.graph_nodes import NodeSpec
from support.complaints import without_middleware_log

TEST_ID = 'DDCT_TEST_ID'
"""Environment variable that marks every process which a test starts, directly or not."""
_PATH = os.environ.get('PYTHONPATH')
_before: set[int] = set()
"""Ids of the processes that were there before this test."""


class ForkedProcess:
    """Process of the fork server with the methods of `Popen` that tests use."""

    def __init__(self, forked: Forked) -> None:
        """Start it."""
        self.forked = forked
        start_processes([forked.process])
        forked.begin()
        self.pid = forked.pid

    def poll(self) -> int | None:
        """Return the exit code, None while it runs."""
        return self.forked.code()

    def wait(self, timeout: float = WITHIN_S) -> int:
        """Wait for its end and return the exit code."""
        assert self.forked.wait(timeout), f'{self.pid} has not ended within {timeout:g} s'
        code = self.forked.code()
        assert code is not None
        return code

    def send_signal(self, number: signal.Signals) -> None:
        """Send it a signal."""
        self.forked.send(number)

    def kill(self) -> None:
        """Kill it."""
        self.send_signal(signal.SIGKILL)


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
        return without_middleware_log(self.stdout.read_text(encoding='utf-8'))

    def errors(self) -> str:
        """Return its standard error so far, without the log of the middleware."""
        return without_middleware_log(self.stderr.read_text(encoding='utf-8'))


class ForkedProgram(Program):
    """Program that the fork server of this process has forked; it prints into one file."""

    def __init__(self, module: str, *arguments: str) -> None:
        """Start `main` of a module."""
        self._forked = Forked(module, *arguments)
        super().__init__(ForkedProcess(self._forked), Path(os.devnull), Path(os.devnull))

    def stop(self) -> None:
        """Stop it as Ctrl-C in its terminal would and require that it ends with code 0."""
        self.send(signal.SIGINT)
        code = self.wait()
        assert code == 0, f'{self.process.pid}: code {code} after SIGINT: {self.errors()}'

    def output(self) -> str:
        """Return all that it has printed so far."""
        return without_middleware_log(self._forked.printed_text())

    errors = output


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
        Start `main` of a module as a fork of the fork server of all tests: without its imports.

        Both streams of output are in one file. It differs in nothing else from `start_module`,
        which takes its place where the test has changed the path of Python.
        """
        if os.environ.get('PYTHONPATH') != _PATH:
            return self.start_module(module, *arguments)
        return self._add(ForkedProgram(module, *arguments))

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
    with os.scandir('/proc') as entries:
        return [int(entry.name) for entry in entries if entry.name.isdigit()]


def processes_left() -> dict[int, str]:
    """Return the command line by id of every other process that this test has started."""
    mark = f'{TEST_ID}={os.environ[TEST_ID]}'.encode()
    left = {}
    for pid in _all_processes():
        if pid in _before or pid in (os.getpid(), server_pid()):
            continue
        folder = Path(f'/proc/{pid}')
        # A process may end, or belong to another user, during the scan.
        with contextlib.suppress(OSError):
            command = (folder / 'cmdline').read_bytes().replace(b'\0', b' ').decode().strip()
            # It ends by itself after those that it serves, which are found without it.
            if 'multiprocessing.resource_tracker' in command:
                continue
            if 'multiprocessing.forkserver' in command:
                if _parent_of(pid) == os.getpid():
                    continue  # that of this process, also before its start has returned its id
                command = f'{(folder / "comm").read_text().strip()}: {command}'
            elif _parent_of(pid) == server_pid():
                continue  # the git that the server asks for the commit while it loads
            marked = mark in (folder / 'environ').read_bytes().split(b'\0')
            # A fork of the shared server has the variables that this one had at its start.
            if marked or _parent_of(pid) == server_pid():
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


def fork_server_of(program: Program) -> int:
    """Return the process id of the fork server of a program, once it is there."""
    found: list[int] = []

    def find() -> bool:
        found[:] = [
            pid
            for pid in children_of(program.process.pid)
            if 'forkserver' in processes_left()[pid]
        ]
        return bool(found)

    wait_until(find, 'a fork server')
    return found[0]
