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
import sys
import time
from collections.abc import Callable, Iterable

from ddct_bringup.processes.jobs import Job
from ddct_bringup.processes.shared_memory import remove_segments, segments_of
from ddct_bringup.processes.warm_parent import WarmParent

PATIENCE_S = 10.0
"""How long nodes have to end by themselves once their supervisor is gone."""
_KILLED_S = 2.0


class Guardian:
    """The guardian of this process's nodes, as a process of its own."""

    def __init__(self, parent: WarmParent, stopped: Callable[[], bool]) -> None:
        """Start it; raise what `WarmParent.start` raises."""
        reader, writer = os.pipe2(os.O_CLOEXEC)
        try:
            (self.process,) = parent.start(
                [Job(__name__, stdin=reader, outlives=True)], stopped=stopped
            )
        except BaseException:
            os.close(writer)
            raise
        finally:
            os.close(reader)
        self._nodes = writer

    def watch(self, pid: int) -> None:
        """Tell it of one more node, a child of ours that has not been waited for."""
        with contextlib.suppress(BrokenPipeError):  # somebody has killed it
            os.write(self._nodes, f'{pid}\n'.encode())

    def dismiss(self) -> None:
        """End it, after the last node has ended."""
        os.close(self._nodes)
        self.process.wait()


def main() -> None:
    """Guard the processes that standard input names."""
    guard(sys.stdin)


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
