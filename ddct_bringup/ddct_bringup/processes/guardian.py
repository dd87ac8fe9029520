"""
A process that outlives a killed supervisor and ends the nodes which that leaves.

The kernel sends such nodes SIGTERM (`end_with_parent`), but a stopped one does not take it and a
hung one does not heed it. The guardian wakes them, so that a recorder can finish its bag, and
kills what is still there `PATIENCE_S` later.
"""

import contextlib
import os
import select
import signal
import subprocess
import sys
import time
from collections.abc import Iterable

from ddct_bringup.processes.shared_memory import remove_segments, segments_of

PATIENCE_S = 10.0
"""How long nodes have to end by themselves once their supervisor is gone."""
_KILLED_S = 2.0


class Guardian:
    """The guardian of this process's nodes, as a process of its own."""

    def __init__(self) -> None:
        """Start it."""
        self._process = subprocess.Popen(
            [sys.executable, '-P', '-m', 'ddct_bringup.processes.guardian'],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )

    def watch(self, pid: int) -> None:
        """Tell it of one more node, a child of ours that has not been waited for."""
        assert self._process.stdin is not None
        with contextlib.suppress(BrokenPipeError):  # somebody has killed it
            self._process.stdin.write(f'{pid}\n'.encode())
            self._process.stdin.flush()

    def dismiss(self) -> None:
        """End it, after the last node has ended."""
        self._process.communicate()


def guard(pids: Iterable[str]) -> None:
    """Take process ids until there are no more: then the supervisor is gone. End the nodes."""
    nodes: dict[int, int] = {}
    for pid in map(int, pids):
        with contextlib.suppress(OSError):
            # From now on the number cannot come to mean another process.
            nodes[os.pidfd_open(pid)] = pid
    segments = {node: segments_of(pid) for node, pid in nodes.items()}
    for node in nodes:
        _send(node, signal.SIGCONT)
    deadline = time.monotonic() + PATIENCE_S
    for node in nodes:
        if not _ends(node, deadline - time.monotonic()):
            _send(node, signal.SIGKILL)
            _ends(node, _KILLED_S)
            remove_segments(segments[node])


def _send(node: int, number: signal.Signals) -> None:
    with contextlib.suppress(ProcessLookupError):
        signal.pidfd_send_signal(node, number)


def _ends(node: int, within_s: float) -> bool:
    """Wait until the process of a descriptor has ended, or for a time in s; say whether it has."""
    ended, _, _ = select.select([node], [], [], max(within_s, 0.0))
    return bool(ended)


if __name__ == '__main__':
    guard(sys.stdin)
