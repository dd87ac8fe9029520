# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Start the graph's nodes as processes, supervise them, and stop them all."""

import signal
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from ddct_bringup.processes.graph_nodes import NodeSpec
from ddct_bringup.processes.guardian import Guardian
from ddct_bringup.processes.node_process import NodeProcess
from ddct_bringup.processes.warm_parent import WarmParent
from ddct_plant.base.errors import DdctError

STOP_LADDER = ((signal.SIGINT, 10.0), (signal.SIGTERM, 5.0), (signal.SIGKILL, 2.0))
"""Signals that stop a node, and the wait after each, s, long enough for a busy machine."""
POLL_S = 0.01
CHECK_PERIOD_S = 0.5
"""Period of the checks of the nodes' pulse and shared memory, s."""
START_CHECK_PERIOD_S, STARTING_S = 0.05, 3.0
"""
Shorter period, s, until so long after the first pulse of the last node: nodes make their shared
memory then, and what was not found before a node is killed is not removed.
"""

SILENT_S = 2.0
"""Time in s without a pulse from which a node may be what one that has failed waited for."""


class NodeProcesses:
    """Processes of one graph; as a context manager it always stops them."""

    def __init__(
        self,
        logs: Path,
        parameter_file: Path,
        parent: WarmParent,
        stopped: Callable[[], bool] = lambda: False,
    ) -> None:
        """
        Store the settings; a log of each node is written into the folder `logs` at the end.

        `parent` forks the nodes, which read their parameters from `parameter_file`. Waiting raises
        KeyboardInterrupt when `stopped()`.
        """
        self._logs = logs
        self._parameter_file = parameter_file
        self._parent = parent
        self._stopped = stopped
        self._nodes: list[NodeProcess] = []

    def __enter__(self) -> 'NodeProcesses':
        self._guardian = Guardian(self._parent, self._stopped)
        return self

    def __exit__(self, *_: object) -> None:
        self.stop(lambda name: True)
        for node in self._nodes:
            node.tidy()
            node.close()
        self._guardian.dismiss()

    def start(self, specs: Sequence[NodeSpec]) -> None:
        """Start one process per node; raise the errors of `WarmParent.start`."""
        nodes = [
            NodeProcess(spec, self._parameter_file, self._logs / spec.log_name) for spec in specs
        ]
        try:
            forked = self._parent.start(
                [node.job for node in nodes], self._guardian.watch, self._stopped
            )
        except BaseException:
            for node in nodes:
                node.close()
            raise
        for node, process in zip(nodes, forked, strict=True):
            node.process = process
            node.close_pulse_writer()
        self._nodes += nodes

    def wait_for(self, name: str) -> None:
        """
        Wait until node `name` has ended with code 0.

        Raise DdctError when any node fails or hangs.
        """
        self._watch(lambda: any(not node.running for node in self._nodes), name)

    def wait_until(self, condition: Callable[[], bool], within_s: float) -> None:
        """
        Wait until `condition()` is true, at most for `within_s` in s.

        Raise DdctError when any node ends or hangs.
        """
        deadline = time.monotonic() + within_s
        self._watch(lambda: condition() or time.monotonic() > deadline)

    def _watch(self, over: Callable[[], bool], may_end: str = '') -> None:
        """
        Check the nodes until `over()` is true.

        Raise DdctError when a node hangs, fails, or ends before the node `may_end`.
        """
        begun_at = checked_at = time.monotonic()
        while True:
            done = over()
            ended = [node for node in self._nodes if not node.running]
            if any(node.name != may_end or node.code != 0 for node in ended):
                # The cause is a node that was killed or failed; others may have ended after it.
                cause = min(ended, key=lambda node: (node.code == 0, node.name == 'driveline'))
                also = self._silences() if cause.code else ''
                raise DdctError(f'{cause.exit_summary()}{also}; its log is {cause.log}')
            if done:
                return
            if self._stopped():
                raise KeyboardInterrupt
            now = time.monotonic()
            if not all(node.begun for node in self._nodes):
                begun_at = now
            starting = now - begun_at < STARTING_S
            if now - checked_at >= (START_CHECK_PERIOD_S if starting else CHECK_PERIOD_S):
                self._check(now - checked_at)
                checked_at = now
            time.sleep(POLL_S)

    def _silences(self) -> str:
        """Return which nodes are silent; another that failed may only have waited for them."""
        silences = [node.silence(SILENT_S) for node in self._nodes if node.running]
        return ''.join(f', and {each}' for each in silences if each)

    def _check(self, elapsed_s: float) -> None:
        for node in self._nodes:
            node.check(elapsed_s)
        for node in self._nodes:
            if summary := node.hang_summary():
                raise DdctError(f'{summary}; its log is {node.log}')

    def stop(self, chosen: Callable[[str], bool]) -> None:
        """Stop the chosen nodes, by SIGINT, then by stronger signals; paused ones are resumed."""
        nodes = [node for node in self._nodes if chosen(node.name)]
        for number, patience_s in STOP_LADDER:
            for node in nodes:
                node.send(number)
            deadline = time.monotonic() + patience_s
            while time.monotonic() < deadline and any(node.running for node in nodes):
                time.sleep(POLL_S)
                for node in nodes:
                    node.check(POLL_S)

    def require_clean_end(self) -> None:
        """Raise DdctError unless every node has ended with code 0."""
        for node in self._nodes:
            if node.code != 0:
                raise DdctError(f'{node.exit_summary()}; its log is {node.log}')
