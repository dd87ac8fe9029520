# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Process that survives a killed supervisor and ends the nodes left behind.

The kernel sends such nodes SIGTERM (`end_with_parent`), but a stopped node does not receive it and
a hung one does not react. The guardian sends SIGCONT, so that a recorder can finish its bag, and
kills nodes that still run `PATIENCE_S` later.
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
"""Wall time for nodes to end by themselves after the end of their supervisor, s."""
_KILLED_S = 2.0


class Guardian:
    """Guardian of this process's nodes, in a process of its own."""

    def __init__(self, parent: WarmParent, stopped: Callable[[], bool]) -> None:
        """Start the guardian; raise the errors of `WarmParent.start`."""
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
        """Add the id of a node: a child process that has not been waited for."""
        with contextlib.suppress(BrokenPipeError):  # the guardian was killed
            os.write(self._nodes, f'{pid}\n'.encode())

    def dismiss(self) -> None:
        """End the guardian, after the last node has ended."""
        os.close(self._nodes)
        self.process.wait()


def main() -> None:
    """Guard the processes whose ids come on standard input."""
    guard(sys.stdin)


def guard(pids: Iterable[str]) -> None:
    """Read process ids until the stream ends with the supervisor; then end those nodes."""
    nodes: dict[int, int] = {}
    for pid in map(int, pids):
        with contextlib.suppress(OSError):
            # The descriptor identifies the process even if its id is used again.
            nodes[os.pidfd_open(pid)] = pid
    segments = {node: segments_of(pid) for node, pid in nodes.items()}
    for node in nodes:
        _send(node, signal.SIGCONT)
    deadline = time.monotonic() + PATIENCE_S
    for node in nodes:
        if not _ends(node, deadline - time.monotonic()):
            _send(node, signal.SIGKILL)
            _ends(node, _KILLED_S)
        # A node that ended with an error may leave them too; those in use are locked.
        remove_segments(segments[node])


def _send(node: int, number: signal.Signals) -> None:
    with contextlib.suppress(ProcessLookupError):
        signal.pidfd_send_signal(node, number)


def _ends(node: int, within_s: float) -> bool:
    """Wait at most `within_s` for the end of a descriptor's process; return whether it ended."""
    ended, _, _ = select.select([node], [], [], max(within_s, 0.0))
    return bool(ended)
