# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Process that survives a killed supervisor and ends the nodes left behind.

The kernel sends such nodes SIGTERM (`end_with_parent`), but a stopped node does not receive it and
a hung one does not react. The guardian sends SIGCONT, so that a recorder can finish its bag, and
kills nodes that still run `PATIENCE_S` later. It looks for their shared memory while they run: a
node that is about to end may be gone before the guardian knows of the end of the supervisor.
"""

import contextlib
import os
import select
import signal
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Mapping

from ddct_bringup.processes.jobs import Job
from ddct_bringup.processes.shared_memory import remove_segments, segments_of
from ddct_bringup.processes.warm_parent import WarmParent

PATIENCE_S = 10.0
"""Wall time for nodes to end by themselves after the end of their supervisor, s."""
_KILLED_S = 2.0
LOOK_S = 0.25
"""Period in s at which nodes that have just started are looked at for their shared memory."""


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
    guard(_lines(sys.stdin.fileno()))


def guard(lines: Iterable[str]) -> None:
    """
    Read process ids until the lines end with the supervisor; then end those nodes.

    At an empty line, look for the shared memory of the nodes.
    """
    nodes: dict[int, int] = {}
    segments = _Segments(nodes)
    for line in lines:
        if not line:
            if not segments.settled:
                segments.look()
            continue
        with contextlib.suppress(OSError):
            # The descriptor identifies the process even if its id is used again.
            nodes[os.pidfd_open(int(line))] = int(line)
    segments.look()
    for node in nodes:
        _send(node, signal.SIGCONT)
    deadline = time.monotonic() + PATIENCE_S
    for node in nodes:
        if not _ends(node, deadline - time.monotonic()):
            _send(node, signal.SIGKILL)
            _ends(node, _KILLED_S)
        # A node that ended with an error may leave them too; those in use are locked.
        remove_segments(segments.of[node])


class _Segments:
    """Shared memory of nodes, by the descriptors of their processes."""

    def __init__(self, nodes: Mapping[int, int]) -> None:
        """Look at nodes, which map descriptors to process ids and may grow."""
        self._nodes = nodes
        self._same = False
        self.of: dict[int, set[str]] = {}
        """Segments that a node has had, by its descriptor."""

    @property
    def settled(self) -> bool:
        """Whether every node has some, and none had more at the last look."""
        return self._same and all(self.of.get(node) for node in self._nodes)

    def look(self) -> None:
        """Add what the nodes have by now."""
        before = {node: set(segments) for node, segments in self.of.items()}
        for node, pid in self._nodes.items():
            self.of.setdefault(node, set()).update(segments_of(pid))
        self._same = self.of == before


def _lines(descriptor: int) -> Iterator[str]:
    """Yield the lines of a stream until it ends, and an empty one whenever none came for long."""
    rest = b''
    while True:
        ready, _, _ = select.select([descriptor], [], [], LOOK_S)
        if not ready:
            yield ''
            continue
        content = os.read(descriptor, 4096)
        if not content:
            return
        *lines, rest = (rest + content).split(b'\n')
        yield from (line.decode() for line in lines)


def _send(node: int, number: signal.Signals) -> None:
    with contextlib.suppress(ProcessLookupError):
        signal.pidfd_send_signal(node, number)


def _ends(node: int, within_s: float) -> bool:
    """Wait at most `within_s` for the end of a descriptor's process; return whether it ended."""
    ended, _, _ = select.select([node], [], [], max(within_s, 0.0))
    return bool(ended)
