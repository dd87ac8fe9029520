"""Start the graph's nodes as processes, watch them, and leave none behind."""

import contextlib
import ctypes
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ddct_bringup.run.graph_nodes import NodeSpec
from ddct_plant.errors import DdctError

STOP_LADDER = ((signal.SIGINT, 10.0), (signal.SIGTERM, 5.0), (signal.SIGKILL, 2.0))
"""Signals to stop a node with, and how long to wait after each, in s; a busy machine is slow."""
POLL_S = 0.01
_SET_PARENT_DEATH_SIGNAL = 1


@dataclass
class NodeProcess:
    """A running node and what it prints."""

    name: str
    process: subprocess.Popen[bytes]
    printed: int
    """File descriptor, in memory: a full disk must not swallow the reason of a failure."""
    log: Path
    """Where `keep_log` writes it."""
    hung: bool = False
    """Whether it had to be killed because it did not stop when asked."""

    def last_words(self) -> str:
        """Return the last line that the node printed, or '' if it printed nothing."""
        lines = self._all_words().decode(errors='replace').strip().splitlines()
        return lines[-1].strip() if lines else ''

    def keep_log(self) -> None:
        """Write what the node printed to its log, if there is room for it."""
        with contextlib.suppress(OSError):
            self.log.write_bytes(self._all_words())
        os.close(self.printed)

    def _all_words(self) -> bytes:
        # Not by seek and read: the node writes at the file position that we share with it.
        return os.pread(self.printed, os.fstat(self.printed).st_size, 0)

    def obituary(self) -> str:
        """Say in one line how the node ended."""
        code = self.process.returncode
        if self.hung:
            return f'node {self.name} did not stop when asked and was killed'
        if code < 0:
            return f'node {self.name} was killed by {signal.Signals(-code).name}'
        words = self.last_words().removeprefix(f'{self.name}: ')
        return f'node {self.name} ended with code {code}{f": {words}" if words else ""}'


class NodeProcesses:
    """The processes of one graph; as a context manager it always stops them."""

    def __init__(self, logs: Path, parameter_file: Path) -> None:
        """Leave `<logs>/<node>.log` at the end; nodes take their parameters from the file."""
        self._logs = logs
        self._parameter_file = parameter_file
        self._nodes: list[NodeProcess] = []

    def __enter__(self) -> 'NodeProcesses':
        return self

    def __exit__(self, *_: object) -> None:
        self.stop(lambda name: True)
        for node in self._nodes:
            node.keep_log()

    def start(self, specs: Sequence[NodeSpec]) -> None:
        """Start one process per node, in the given order."""
        for spec in specs:
            command = [sys.executable, '-m', spec.module]
            command += ['--ros-args', '--params-file', str(self._parameter_file)]
            printed = os.memfd_create(spec.name)
            process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=printed,
                stderr=subprocess.STDOUT,
                start_new_session=True,
                preexec_fn=end_with_parent,
            )
            log = self._logs / f'{spec.name}.log'
            self._nodes.append(NodeProcess(spec.name, process, printed, log))

    def wait_for(self, name: str, stopped: Callable[[], bool]) -> None:
        """Wait until node `name` has done its work; raise DdctError when any node fails."""
        while True:
            ended = [node for node in self._nodes if node.process.poll() is not None]
            if any(node.name != name or node.process.returncode != 0 for node in ended):
                culprit = _culprit(ended)
                raise DdctError(f'{culprit.obituary()}; its log is {culprit.log}')
            if ended:
                return
            if stopped():
                raise KeyboardInterrupt
            time.sleep(POLL_S)

    def stop(self, chosen: Callable[[str], bool]) -> None:
        """Stop the chosen nodes, first by SIGINT, then harder."""
        nodes = [node for node in self._nodes if chosen(node.name)]
        for number, patience_s in STOP_LADDER:
            for node in nodes:
                if node.process.poll() is None:
                    node.hung = number == signal.SIGKILL
                    node.process.send_signal(number)
            deadline = time.monotonic() + patience_s
            while time.monotonic() < deadline and _running(nodes):
                time.sleep(POLL_S)
            if not _running(nodes):
                break

    def require_clean_end(self) -> None:
        """Raise DdctError unless every node has ended with code 0."""
        for node in self._nodes:
            if node.process.returncode != 0:
                raise DdctError(f'{node.obituary()}; its log is {node.log}')


def _running(nodes: Sequence[NodeProcess]) -> bool:
    return any(node.process.poll() is None for node in nodes)


def _culprit(ended: Sequence[NodeProcess]) -> NodeProcess:
    """Return the node to blame: one that was killed or failed before one that noticed."""
    return min(ended, key=lambda node: (node.process.returncode == 0, node.name == 'driveline'))


def end_with_parent() -> None:
    """Let the kernel end this node should the supervisor itself be killed (Linux)."""
    ctypes.CDLL(None).prctl(_SET_PARENT_DEATH_SIGNAL, signal.SIGTERM)
