# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Start the graph's nodes as processes, watch them, and stop them all.

Nobody guards the nodes from outside: a node ends itself when the program ends, and when it hangs
(`ddct_plant.program.supervision`). The supervisor names the node that was the cause.
"""

import contextlib
import select
import signal
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from ddct_bringup.processes.fork_server import start_processes, state_of
from ddct_bringup.processes.forked import Forked
from ddct_bringup.processes.graph_nodes import DRIVELINE, NodeSpec
from ddct_bringup.processes.shared_memory import remove_dead_segments
from ddct_plant.base.errors import DdctError
from ddct_plant.program.own_process import last_call
from ddct_plant.program.supervision import Patience, adopt_orphans

STOP_LADDER = ((signal.SIGINT, 10.0), (signal.SIGTERM, 5.0), (signal.SIGKILL, 2.0))
"""Signals that stop a node, and the wait after each, s, long enough for a busy machine."""
PATIENCE = Patience()
PAUSED_S = 15.0
"""
Wall time in s after which a paused node (SIGSTOP) ends the run: before it would count as hung, so
that it is resumed in time to end in order.
"""
POLL_S = 0.05
"""Period in s at which a wait looks whether it is over; it ends at once when a node ends."""
CHECK_PERIOD_S = 0.5
"""Period in s at which paused nodes are looked for."""
_MOST_ELAPSED_S = 1.0
"""Largest time between two checks that counts, s: the supervisor may have been paused too."""


class Node(Forked):
    """Process of a node, and how it ended."""

    def __init__(self, spec: NodeSpec, arguments: Sequence[str], log: Path) -> None:
        """Prepare the node with ROS arguments; `write_log` writes its output into `log`."""
        self.name = spec.path
        self._title = spec.title
        self.log = log
        self.killed = False
        """Whether it had to be killed because it did not end after the other signals."""
        self._paused_s = 0.0
        given = [*spec.arguments, *arguments]
        super().__init__(spec.module, *given, name=spec.path, patience=PATIENCE)

    def check(self, elapsed_s: float) -> None:
        """Raise DdctError where somebody has paused it for long, `elapsed_s` after the last."""
        paused = state_of(self.pid) == 'T'
        self._paused_s = self._paused_s + min(elapsed_s, _MOST_ELAPSED_S) if paused else 0.0
        if self._paused_s > PAUSED_S:
            raise DdctError(
                f'{self._title} has been paused (SIGSTOP) for {PAUSED_S:g} s; its log is '
                f'{self.log}'
            )

    def stop(self, number: signal.Signals) -> None:
        """Send a signal, and SIGCONT, to a node that has not ended."""
        if self.running:
            self.killed = number == signal.SIGKILL
            self.send(number)
            self.send(signal.SIGCONT)

    def write_log(self) -> None:
        """Write the log of an ended node; a full disk has no room for it."""
        with contextlib.suppress(OSError):
            self.log.write_bytes(self.printed())

    def ended_well(self) -> bool:
        """Return whether it has ended with code 0, by itself: exit(0) in C announces nothing."""
        return self.code() == 0 and self.announced_code() == 0

    def summary(self) -> str:
        """Return one line on how the node ended, with its log."""
        return f'{self._title} {self._end()}; its log is {self.log}'

    def _end(self) -> str:
        code = self.code()
        lines = [line for line in self.lines() if not line.startswith('[INFO]')]
        call = last_call(self.calls()) if self.announced_code() is None else ''
        if self.killed:
            return f'did not stop on signals{call} and was killed'
        if code is None:
            return 'has ended, and the fork server, which knows why, was killed or is paused'
        if code < 0:
            return f'was killed by {signal.Signals(-code).name}{call}'
        # What the standard library's watch prints before it ends the process.
        if code and any(line.startswith('Timeout (') and line.endswith(')!') for line in lines):
            return f'hung{call} and ended itself, its stacks are in its log'
        program = self.name.rpartition('/')[2]
        words = lines[-1].strip().removeprefix(f'{program}: ') if lines else ''
        return f'ended with code {code}{call}{f": {words}" if words else ""}'


class Supervisor:
    """Processes of one graph; as a context manager it always stops them."""

    def __init__(
        self,
        logs: Path,
        arguments_of: Callable[[NodeSpec], Sequence[str]],
        stopped: Callable[[], bool] = lambda: False,
    ) -> None:
        """
        Store the settings; a log of each node is written into the folder `logs` at the end.

        Each node has the ROS arguments of `arguments_of`. Waiting raises KeyboardInterrupt when
        `stopped()`.
        """
        self._logs = logs
        self._arguments_of = arguments_of
        self._stopped = stopped
        self._nodes: list[Node] = []

    def __enter__(self) -> 'Supervisor':
        adopt_orphans(adopt=True)  # for the exit codes of nodes whose fork server was killed
        return self

    def __exit__(self, *_: object) -> None:
        self.stop(lambda name: True)
        for node in self._nodes:
            node.write_log()
        # A killed node leaves its shared memory, also one that hung after its announced end, and
        # one that ended with an error may leave it.
        if any(not node.ended_well() or node.process.exitcode != 0 for node in self._nodes):
            remove_dead_segments()
        for node in self._nodes:
            node.close()
        adopt_orphans(adopt=False)

    def start(self, specs: Sequence[NodeSpec]) -> None:
        """Start one process per node; raise the errors of `start_processes`."""
        nodes = [
            Node(spec, self._arguments_of(spec), self._logs / spec.log_name) for spec in specs
        ]
        try:
            start_processes([node.process for node in nodes], self._stopped)
        finally:
            for node in nodes:
                if node.pid:
                    node.begin()
                    self._nodes.append(node)
                else:
                    node.close()

    def wait_for(self, name: str) -> None:
        """
        Wait until node `name` has ended well.

        Raise DdctError when any node fails, hangs, or is paused for long.
        """
        self._watch(lambda: any(not node.running for node in self._nodes), name)

    def wait_until(self, condition: Callable[[], bool], within_s: float) -> None:
        """
        Wait until `condition()` is true, at most for `within_s` in s.

        Raise DdctError when any node ends or is paused for long.
        """
        deadline = time.monotonic() + within_s
        self._watch(lambda: condition() or time.monotonic() > deadline)

    def _watch(self, over: Callable[[], bool], may_end: str = '') -> None:
        """
        Check the nodes until `over()` is true.

        Raise DdctError when a node fails, or ends before the node `may_end`.
        """
        checked_at = time.monotonic()
        while True:
            done = over()
            ended = [node for node in self._nodes if not node.running]
            if any(node.name != may_end or not node.ended_well() for node in ended):
                # The cause is a node that was killed or failed; others may have ended after it.
                raise DdctError(min(ended, key=_consequence).summary())
            if done:
                return
            if self._stopped():
                raise KeyboardInterrupt
            now = time.monotonic()
            if now - checked_at >= CHECK_PERIOD_S:
                for node in self._nodes:
                    node.check(now - checked_at)
                checked_at = now
            _any_ends(self._nodes, POLL_S)

    def stop(self, chosen: Callable[[str], bool]) -> None:
        """Stop the chosen nodes, by SIGINT, then by stronger signals; paused ones are resumed."""
        nodes = [node for node in self._nodes if chosen(node.name)]
        for number, patience_s in STOP_LADDER:
            for node in nodes:
                node.stop(number)
            deadline = time.monotonic() + patience_s
            while nodes and (left_s := deadline - time.monotonic()) > 0.0:
                _any_ends(nodes, left_s)
                nodes = [node for node in nodes if node.running]

    def require_clean_end(self) -> None:
        """Raise DdctError unless every node has ended well."""
        for node in self._nodes:
            if not node.ended_well():
                raise DdctError(node.summary())


def _any_ends(nodes: Sequence[Node], within_s: float) -> None:
    """Wait until one of the nodes has ended, at most for `within_s` in s."""
    select.select([node.ended for node in nodes if node.ended is not None], [], [], within_s)


def _consequence(node: Node) -> tuple[bool, bool]:
    """Return a key that is larger for an ended node whose end others have caused."""
    return node.ended_well(), node.name == DRIVELINE.path
