# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Program of the warm parent: imports what nodes need, then forks processes on request.

It makes no ROS context and no participant, and its only threads are those of `tracing_locks.py`,
so that a fork is as good as a new process. Its forks become children of the supervisor, which is
its own parent: see `_fork_all`.
"""

import atexit
import contextlib
import ctypes
import gc
import importlib
import json
import os
import signal
import socket
import sys
import threading
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import NoReturn

from ddct_bringup.processes.jobs import ForkRequest, JobText
from ddct_bringup.processes.preloading import preload
from ddct_bringup.processes.tracing_locks import TracingLocks
from ddct_plant.program.supervision import PULSE_FD, end_with_parent, stems_from_interrupt

MOST_DESCRIPTORS = 250
"""Largest number of descriptors in one request; the kernel's limit is 253."""
GO = b'g'
"""Byte that the supervisor writes once it has registered a process, which then starts to work."""
DONE = b'd'
"""Byte that the warm parent sends when it has forked the processes of a request."""
_ARGUMENTS_START = 48 - 1 - 2
_ARGUMENTS_END = 49 - 1 - 2
"""Index of arg_end behind the process name in /proc/self/stat, by man 5 proc."""


def main() -> int:
    """Serve the supervisor over the socket whose descriptor is the first argument."""
    channel = socket.socket(fileno=int(sys.argv[1]))
    # Imported objects stay: garbage collection takes a fifth of the import time, and in a
    # fork it would write to every shared page.
    gc.disable()
    preload()
    gc.freeze()
    gc.enable()
    locks = TracingLocks()
    while True:
        data, descriptors, _, _ = socket.recv_fds(channel, 1, MOST_DESCRIPTORS)
        if not data:
            return 0
        _answer(channel, descriptors, locks)
        for descriptor in descriptors:
            os.close(descriptor)


def _answer(channel: socket.socket, descriptors: list[int], locks: TracingLocks) -> None:
    """Fork the processes of the request in the first descriptor; send `DONE` when all exist."""
    request: ForkRequest = json.loads(
        os.pread(descriptors[0], os.fstat(descriptors[0]).st_size, 0)
    )
    between = locks.fork()
    if between == 0:
        channel.close()
        _fork_all(request, descriptors, locks)
    os.waitpid(between, 0)
    channel.sendall(DONE)


def _fork_all(request: ForkRequest, descriptors: list[int], locks: TracingLocks) -> NoReturn:
    """
    Fork all processes of a request, write this process's id and theirs into a pipe, and exit.

    The supervisor has the other end of the pipe, the third descriptor, so that it can wait for
    them after a failed start too. The exit makes them orphans, and the kernel gives orphans to the
    next living ancestor that is a subreaper: the supervisor, not the warm parent.
    """
    try:
        os.write(descriptors[2], b'%d ' % os.getpid())
        for index, job in enumerate(request['jobs']):
            pid = locks.fork()
            if pid == 0:
                _become(job, index, request, descriptors)
            os.write(descriptors[2], b'%d ' % pid)
    except OSError:
        traceback.print_exc()
    finally:
        os._exit(0)


def _become(job: JobText, index: int, request: ForkRequest, descriptors: list[int]) -> NoReturn:
    """Run a job in this fork, as if Python had been started for it."""
    code = 1
    try:
        os.setsid()
        # Without this byte the supervisor or the warm parent has ended, or has cancelled the job.
        if os.read(descriptors[1], 1) == GO:
            if not job['outlives']:
                end_with_parent(request['supervisor'])
            # On a busy machine the supervisor may have ended before the guardian starts to work.
            if job['outlives'] or os.getppid() == request['supervisor']:
                _take_over(job, request['environment'], index, descriptors)
                code = exit_code(lambda: importlib.import_module(job['module']).main())
    finally:
        _end(code)


def _take_over(
    job: JobText, environment: dict[str, str], index: int, descriptors: list[int]
) -> None:
    """Set standard streams, environment and command line of this process to those of the job."""
    stdin, output, pulse = descriptors[3 + 3 * index :][:3]
    for source, target in ((stdin, 0), (output, 1), (output, 2)):
        os.dup2(source, target)
    for descriptor in descriptors:
        if descriptor != pulse or not job['pulse']:
            os.close(descriptor)
    os.environ.clear()
    os.environ.update(environment)
    if job['pulse']:
        os.environ[PULSE_FD] = str(pulse)
    sys.argv = [job['module'], *job['arguments']]
    _show_as([sys.executable, '-P', '-m', job['module']])
    _seed_anew()


def exit_code(work: Callable[[], int | None]) -> int:
    """Run a program's main function and return its exit code, as Python does for a main module."""
    try:
        return work() or 0
    except SystemExit as end:
        if end.code is None or isinstance(end.code, int):
            return end.code or 0
        print(end.code, file=sys.stderr)
    except BaseException as error:
        if stems_from_interrupt(error):
            signal.signal(signal.SIGINT, signal.SIG_DFL)
            os.kill(os.getpid(), signal.SIGINT)
        traceback.print_exc()
    return 1


def _end(code: int) -> NoReturn:
    """
    End this process as Python would, but leave its memory to the kernel.

    Freeing the interpreter and the middleware's libraries takes longer than a node's start.
    """
    try:
        threading._shutdown()  # type: ignore[attr-defined]
        atexit._run_exitfuncs()
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(OSError, ValueError, AttributeError):
                stream.flush()
    finally:
        os._exit(code & 0xFF)


def _show_as(command: list[str]) -> None:
    """Replace the warm parent's command line in `ps` by this one, as far as there is room."""
    stat = Path('/proc/self/stat').read_text(encoding='ascii', errors='replace')
    fields = stat.rpartition(')')[2].split()
    start, end = int(fields[_ARGUMENTS_START]), int(fields[_ARGUMENTS_END])
    room = end - start
    text = b'\0'.join(map(os.fsencode, command))
    if start and room > len(text):
        ctypes.memmove(start, text.ljust(room, b'\0'), room)


def _seed_anew() -> None:
    """Seed numpy's global generator again; Python does so for its own after each fork."""
    if 'numpy.random' in sys.modules:
        sys.modules['numpy.random'].seed()


if __name__ == '__main__':
    raise SystemExit(main())
