"""
The program of the warm parent: imports what nodes need, then forks a process at each request.

It makes no ROS context and no participant, and its only threads are those of `tracing_locks.py`,
so that a fork is as good as a new process. What it forks becomes a child of the supervisor, which
is its own parent: see `_fork_all`.
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
from typing import Any, NoReturn

from ddct_bringup.processes.preloading import preload
from ddct_bringup.processes.tracing_locks import TracingLocks
from ddct_plant.program.supervision import PULSE_FD, end_with_parent

MOST_DESCRIPTORS = 250
"""That one request may bring; the kernel takes 253."""
GO = b'g'
"""What the supervisor writes once it knows of a process: then that process begins its work."""
_ARGUMENTS_START = 48 - 1 - 2
_ARGUMENTS_END = 49 - 1 - 2
"""Places in /proc/self/stat behind the name, by man 5 proc."""


def main() -> int:
    """Serve the supervisor over the socket whose descriptor is the first argument."""
    channel = socket.socket(fileno=int(sys.argv[1]))
    # What is imported stays: to look for garbage in it takes a fifth of the time, and in a fork
    # would write to every page that it shares with us.
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
    """Fork what the request in the first descriptor asks for; send the process ids as a line."""
    request = json.loads(os.pread(descriptors[0], os.fstat(descriptors[0]).st_size, 0))
    reader, writer = os.pipe()
    between = locks.fork()
    if between == 0:
        channel.close()
        os.close(reader)
        _fork_all(request, descriptors, writer, locks)
    os.close(writer)
    os.waitpid(between, 0)
    with os.fdopen(reader, 'rb') as pipe:
        channel.sendall(pipe.readline() or b'[]\n')


def _fork_all(
    request: dict[str, Any], descriptors: list[int], writer: int, locks: TracingLocks
) -> NoReturn:
    """
    Fork all processes of a request, write their ids into a pipe, and end.

    With that end they are orphans, and the kernel gives them to the next living ancestor that
    takes orphans: the supervisor, not us.
    """
    pids = []
    try:
        for index, job in enumerate(request['jobs']):
            pid = locks.fork()
            if pid == 0:
                os.close(writer)
                _become(job, index, request, descriptors)
            pids.append(pid)
    except OSError:
        traceback.print_exc()
    finally:
        os.write(writer, json.dumps(pids).encode() + b'\n')
        os._exit(0)


def _become(
    job: dict[str, Any], index: int, request: dict[str, Any], descriptors: list[int]
) -> NoReturn:
    """Be the process of a job from now on, as if Python had been started for it."""
    code = 1
    try:
        os.setsid()
        # Without it the supervisor or the warm parent is gone, or does not want us any more.
        if os.read(descriptors[1], 1) == GO:
            if not job['outlives']:
                end_with_parent()
            if os.getppid() == request['supervisor']:
                _take_over(job, request['environment'], index, descriptors)
                code = exit_code(lambda: importlib.import_module(job['module']).main())
    finally:
        _end(code)


def _take_over(
    job: dict[str, Any], environment: dict[str, str], index: int, descriptors: list[int]
) -> None:
    """Take standard streams, environment and command line from the job."""
    stdin, output, pulse = descriptors[2 + 3 * index :][:3]
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
    """Do a program's work and return its exit code, as Python does it for a main module."""
    try:
        return work() or 0
    except SystemExit as end:
        if end.code is None or isinstance(end.code, int):
            return end.code or 0
        print(end.code, file=sys.stderr)
    except KeyboardInterrupt:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGINT)
    except BaseException:
        traceback.print_exc()
    return 1


def _end(code: int) -> NoReturn:
    """
    End this process as Python would, but leave its memory to the kernel.

    To take the interpreter and the middleware's libraries apart costs more than a node's start.
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
    """Let `ps` show this command line in place of the warm parent's, as far as there is room."""
    stat = Path('/proc/self/stat').read_text(encoding='ascii', errors='replace')
    fields = stat.rpartition(')')[2].split()
    start, end = int(fields[_ARGUMENTS_START]), int(fields[_ARGUMENTS_END])
    room = end - start
    text = b'\0'.join(map(os.fsencode, command))
    if start and room > len(text):
        ctypes.memmove(start, text.ljust(room, b'\0'), room)


def _seed_anew() -> None:
    """Seed numpy's global generator anew; Python does it for its own after each fork."""
    if 'numpy.random' in sys.modules:
        sys.modules['numpy.random'].seed()


if __name__ == '__main__':
    raise SystemExit(main())
