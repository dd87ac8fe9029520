"""Start the graph's nodes as processes, watch them, and leave none behind."""

import ctypes
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ddct_bringup.graph_nodes import NodeSpec
from ddct_plant.errors import DdctError

STOP_LADDER = ((signal.SIGINT, 3.0), (signal.SIGTERM, 2.0), (signal.SIGKILL, 2.0))
"""Signals to stop a node with, and how long to wait after each, in s."""
POLL_S = 0.01
_SET_PARENT_DEATH_SIGNAL = 1


@dataclass
class NodeProcess:
    """A running node and the file that holds what it prints."""

    name: str
    process: subprocess.Popen[bytes]
    log: Path

    def last_words(self) -> str:
        """Return the last line that the node printed, or '' if it printed nothing."""
        lines = self.log.read_text(encoding='utf-8', errors='replace').strip().splitlines()
        return lines[-1].strip() if lines else ''

    def obituary(self) -> str:
        """Say in one line how the node ended."""
        code = self.process.returncode
        if code < 0:
            return f'node {self.name} was killed by {signal.Signals(-code).name}'
        words = self.last_words().removeprefix(f'{self.name}: ')
        return f'node {self.name} ended with code {code}{f": {words}" if words else ""}'


class NodeProcesses:
    """The processes of one graph; as a context manager it always stops them."""

    def __init__(self, logs: Path, parameter_file: Path) -> None:
        """Nodes print to `<logs>/<node>.log` and take their parameters from the file."""
        self._logs = logs
        self._parameter_file = parameter_file
        self._nodes: list[NodeProcess] = []

    def __enter__(self) -> 'NodeProcesses':
        return self

    def __exit__(self, *_: object) -> None:
        self.stop(lambda name: True)

    def start(self, specs: Sequence[NodeSpec]) -> None:
        """Start one process per node, in the given order."""
        self._logs.mkdir(exist_ok=True)
        for spec in specs:
            log = self._logs / f'{spec.name}.log'
            command = [sys.executable, '-m', spec.module]
            command += ['--ros-args', '--params-file', str(self._parameter_file)]
            with log.open('wb') as output:
                process = subprocess.Popen(
                    command,
                    stdin=subprocess.DEVNULL,
                    stdout=output,
                    stderr=subprocess.STDOUT,
                    start_new_session=True,
                    preexec_fn=_end_with_parent,
                )
            self._nodes.append(NodeProcess(spec.name, process, log))

    def wait_for(self, name: str, stopped: Callable[[], bool]) -> None:
        """Wait until node `name` has done its work; raise DdctError when any node fails."""
        while True:
            ended = [node for node in self._nodes if node.process.poll() is not None]
            for node in ended:
                if node.name != name or node.process.returncode != 0:
                    raise DdctError(f'{_culprit(ended).obituary()}; its log is {node.log}')
            if ended:
                return
            if stopped():
                raise KeyboardInterrupt
            time.sleep(POLL_S)

    def stop(self, chosen: Callable[[str], bool]) -> None:
        """Stop the chosen nodes, first by SIGINT, then harder; raise DdctError if one fails."""
        nodes = [node for node in self._nodes if chosen(node.name)]
        for number, patience_s in STOP_LADDER:
            for node in nodes:
                if node.process.poll() is None:
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


def _end_with_parent() -> None:
    """Let the kernel end this node should the supervisor itself be killed (Linux)."""
    ctypes.CDLL(None).prctl(_SET_PARENT_DEATH_SIGNAL, signal.SIGTERM)
