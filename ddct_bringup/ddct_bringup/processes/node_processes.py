"""Start the graph's nodes as processes, watch them, and leave none behind."""

import signal
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from ddct_bringup.processes.graph_nodes import NodeSpec
from ddct_bringup.processes.guardian import Guardian
from ddct_bringup.processes.node_process import NodeProcess
from ddct_plant.base.errors import DdctError

STOP_LADDER = ((signal.SIGINT, 10.0), (signal.SIGTERM, 5.0), (signal.SIGKILL, 2.0))
"""Signals to stop a node with, and how long to wait after each, in s; a busy machine is slow."""
POLL_S = 0.01
LOOK_S = 0.5
"""How often the nodes' pulse and shared memory are looked at."""


class NodeProcesses:
    """The processes of one graph; as a context manager it always stops them."""

    def __init__(self, logs: Path, parameter_file: Path) -> None:
        """Leave `<logs>/<node>.log` at the end; nodes take their parameters from the file."""
        self._logs = logs
        self._parameter_file = parameter_file
        self._nodes: list[NodeProcess] = []

    def __enter__(self) -> 'NodeProcesses':
        self._guardian = Guardian()
        return self

    def __exit__(self, *_: object) -> None:
        self.stop(lambda name: True)
        for node in self._nodes:
            node.close()
        self._guardian.dismiss()

    def start(self, specs: Sequence[NodeSpec]) -> None:
        """Start one process per node, in the given order."""
        for spec in specs:
            log = self._logs / f'{spec.name}.log'
            node = NodeProcess(spec, self._parameter_file, log)
            self._nodes.append(node)
            self._guardian.watch(node.process.pid)

    def wait_for(self, name: str, stopped: Callable[[], bool]) -> None:
        """
        Wait until node `name` has done its work.

        Raise DdctError when any node fails or hangs, KeyboardInterrupt when `stopped()`.
        """
        looked_at = time.monotonic()
        while True:
            ended = [node for node in self._nodes if not node.running]
            if any(node.name != name or node.code != 0 for node in ended):
                # To blame is one that was killed or failed, before one that noticed.
                culprit = min(ended, key=lambda node: (node.code == 0, node.name == 'driveline'))
                raise DdctError(f'{culprit.obituary()}; its log is {culprit.log}')
            if ended:
                return
            if stopped():
                raise KeyboardInterrupt
            now = time.monotonic()
            if now - looked_at >= LOOK_S:
                self._look(now - looked_at)
                looked_at = now
            time.sleep(POLL_S)

    def _look(self, elapsed_s: float) -> None:
        for node in self._nodes:
            node.look(elapsed_s)
        for node in self._nodes:
            if silence := node.silence():
                raise DdctError(f'{silence}; its log is {node.log}')

    def stop(self, chosen: Callable[[str], bool]) -> None:
        """Stop the chosen nodes, first by SIGINT, then harder; one that was stopped goes on."""
        nodes = [node for node in self._nodes if chosen(node.name)]
        for number, patience_s in STOP_LADDER:
            for node in nodes:
                node.send(number)
            deadline = time.monotonic() + patience_s
            while time.monotonic() < deadline and any(node.running for node in nodes):
                time.sleep(POLL_S)
                for node in nodes:
                    node.look(POLL_S)

    def require_clean_end(self) -> None:
        """Raise DdctError unless every node has ended with code 0."""
        for node in self._nodes:
            if node.code != 0:
                raise DdctError(f'{node.obituary()}; its log is {node.log}')
