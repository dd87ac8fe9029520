# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Warm parent: a process that has imported what nodes need, and forks them on request.

Importing takes a node far longer than everything else before its first tick. Forks of the warm
parent become children of this process, like processes that it starts itself.
"""

import contextlib
import os
import select
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from ddct_bringup.processes.forked_process import ForkedProcess
from ddct_bringup.processes.forks import GO
from ddct_bringup.processes.jobs import Job, send_request
from ddct_plant.base.errors import DdctError
from ddct_plant.program.supervision import adopting_orphans, end_with_parent

START_S = 60.0
"""Timeout for importing everything and forking, s, long enough for a busy machine."""
_SLICE_S = 0.05
"""Period of the checks of `stopped` during a wait for the warm parent, s."""
_END_S = 5.0
"""Timeout for the end of the warm parent after its channel is closed, s."""
_IDS_BYTES = 1 << 16
"""Capacity of the pipe of process ids in bytes (Linux)."""
_ROOM = ' ' * 400
"""Unused argument: room for the command lines that forks write over the warm parent's."""


class WarmParent:
    """Running warm parent; it ends with this process, or with `close`."""

    def __init__(self) -> None:
        """Start the warm parent; it imports while this process continues."""
        self._launch()

    def _launch(self) -> None:
        self._channel, theirs = socket.socketpair()
        # In memory: the reason of a failure must survive a full disk.
        self._printed = os.fdopen(os.memfd_create('warm_parent'), 'rb')
        ours = os.getpid()
        self.process = subprocess.Popen(
            # -P: a file of the current folder must not hide a module of the same name.
            [
                *(sys.executable, '-P', '-m', 'ddct_bringup.processes.forks'),
                *(str(theirs.fileno()), _ROOM),
            ],
            stdin=subprocess.DEVNULL,
            stdout=self._printed,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            preexec_fn=lambda: end_with_parent(ours, signal.SIGKILL),
            pass_fds=[theirs.fileno()],
            # Its numerics must have no threads when it forks; nodes get our environment.
            env={'OPENBLAS_NUM_THREADS': '1', **os.environ},
        )
        theirs.close()

    def __enter__(self) -> 'WarmParent':
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the warm parent; its forks continue."""
        self.process.kill()
        self.process.wait()
        self._channel.close()
        self._printed.close()

    def start(
        self,
        jobs: Sequence[Job],
        watch: Callable[[int], None] = lambda pid: None,
        stopped: Callable[[], bool] = lambda: False,
    ) -> list[ForkedProcess]:
        """
        Fork a process for each job, with the current environment of this process.

        `watch(pid)` is called for each process before any of them starts to work. Raise DdctError
        when the warm parent fails, and KeyboardInterrupt when `stopped()` becomes true before its
        answer. Then none of the processes is left, the warm parent is ended, and the next call
        starts another one.
        """
        if self.process.poll() is not None:  # killed since the last start
            self.close()
            self._launch()
        waiting, go = os.pipe2(os.O_CLOEXEC)
        ids, born = os.pipe2(os.O_CLOEXEC)
        pids: list[int] = []
        with adopting_orphans():
            try:
                try:
                    with contextlib.suppress(BrokenPipeError, ConnectionResetError):
                        send_request(self._channel, jobs, waiting, born)
                finally:
                    os.close(waiting)
                    os.close(born)
                self._wait_for_forks(stopped)
                pids += _read_ids(ids)
                forked = self._forked(pids, jobs)
                for process in forked:
                    watch(process.pid)
                os.write(go, GO * len(forked))
            except BaseException:
                # Its late answer would be taken for that to the next request.
                self.close()
                os.close(go)
                _reap(pids, ids)
                os.close(ids)
                raise
        os.close(go)
        os.close(ids)
        return forked

    def _wait_for_forks(self, stopped: Callable[[], bool]) -> None:
        """Wait until the warm parent has forked the processes; raise the errors of `start`."""
        deadline = time.monotonic() + START_S
        while True:
            if stopped():
                raise KeyboardInterrupt
            if time.monotonic() > deadline:
                raise DdctError(f'nodes could not be started within {START_S:g} s')
            if select.select([self._channel], [], [], _SLICE_S)[0]:
                with contextlib.suppress(ConnectionResetError):
                    if self._channel.recv(1):
                        return
                with contextlib.suppress(subprocess.TimeoutExpired):
                    self.process.wait(_END_S)
                raise DdctError(f'nodes cannot be started: {self._last_line()}')

    def _forked(self, pids: Sequence[int], jobs: Sequence[Job]) -> list[ForkedProcess]:
        """
        Return the processes of the jobs; raise DdctError where one could not be forked.

        The first of `pids` is that of the process which forked the others, and has ended.
        """
        forked = [ForkedProcess(pid, job.module) for pid, job in zip(pids[1:], jobs, strict=False)]
        if len(forked) < len(jobs):
            raise DdctError(f'no process for {jobs[len(forked)].module}: {self._last_line()}')
        return forked

    def _last_line(self) -> str:
        code = self.process.poll()
        if code == -signal.SIGKILL:
            return 'the warm parent, which forks them, was killed'
        # Not by seek and read: both processes share the file position at which it writes.
        printed = self._printed.fileno()
        text = os.pread(printed, os.fstat(printed).st_size, 0).decode(errors='replace')
        return (text.strip().splitlines() or [f'the warm parent ended with code {code}'])[-1]


def _read_ids(ids: int) -> list[int]:
    """Return the process ids that are in the pipe with this descriptor."""
    return [int(word) for word in os.read(ids, _IDS_BYTES).split()]


def _reap(pids: list[int], ids: int) -> None:
    """Wait for the processes of a failed start; further ids are in the pipe `ids`."""
    deadline = time.monotonic() + _END_S
    # The pipe ends with them: each has its other end, and ends because it is not let go.
    while select.select([ids], [], [], max(deadline - time.monotonic(), 0.0))[0]:
        more = _read_ids(ids)
        if not more:
            break
        pids += more
    for pid in pids:
        with contextlib.suppress(subprocess.TimeoutExpired):
            ForkedProcess(pid, 'fork').wait(max(deadline - time.monotonic(), 0.0))


_ahead: list[WarmParent] = []
"""Warm parents started ahead, at most one; `warm_parent` takes it out."""


@contextmanager
def started_ahead() -> Iterator[None]:
    """Start a warm parent while its program is still imported; close it at the end."""
    with WarmParent() as parent:
        _ahead.append(parent)
        try:
            yield
        finally:
            _ahead.clear()


def warm_parent() -> WarmParent:
    """Return the warm parent that was started ahead, or start one."""
    return _ahead.pop() if _ahead else WarmParent()
