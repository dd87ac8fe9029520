# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The fork server of `multiprocessing`, one for all runs of a program.

Imports take a node longer than everything else before its first tick. The server does them once,
see `preloaded`, and forks the nodes of every run.
"""

import atexit
import contextlib
import multiprocessing
import os
import select
import signal
import sys
import threading
import time
import types
from collections.abc import Callable, Iterator, Sequence
from multiprocessing import forkserver, resource_tracker
from multiprocessing.context import ForkServerProcess
from pathlib import Path

from ddct_plant.base.errors import DdctError
from ddct_plant.program.signals import deferred_signals, held_back

CONTEXT = multiprocessing.get_context('forkserver')
START_S = 60.0
"""Timeout for the imports of the fork server and its forks, s, long enough for a busy machine."""
_SLICE_S = 0.02
"""Period in s at which a start looks whether it is cancelled."""
MARK = 'DDCT_FORK_SERVER'
"""
Environment variable of the fork server alone, with the process id of its program; without
it the module that the server imports first does nothing.
"""
_PRELOADED = 'ddct_bringup.processes.preloaded'


def start_server() -> None:
    """Start the fork server, which imports meanwhile; do nothing where it runs already."""
    CONTEXT.set_forkserver_preload([_PRELOADED])
    atexit.unregister(_stop_with)
    atexit.register(_stop_with, os.getpid())
    # -P as a variable: a file of the current folder must not hide a module of the same name.
    given = {MARK: str(os.getpid()), 'PYTHONSAFEPATH': '1'}
    with deferred_signals(), _own_modules_alone(), _environment(given):
        # The library starts this one first, and lets signals through afterwards.
        resource_tracker.ensure_running()
        try:
            with held_back():  # until it has its own group: Ctrl-C in a terminal is not for it
                forkserver.ensure_running()
        except OSError as error:
            raise _cannot_start(error) from error


def stop_server() -> None:
    """Kill the fork server, if it runs; its nodes go on."""
    if pid := server_pid():
        with contextlib.suppress(ProcessLookupError):
            ended = os.pidfd_open(pid)
            os.kill(pid, signal.SIGKILL)
            select.select([ended], [], [])
            os.close(ended)


def _stop_with(program: int) -> None:
    if os.getpid() == program:  # and not a fork of it
        stop_server()


def server_pid() -> int:
    """Return the process id of the running fork server, 0 without one."""
    # The standard library has no public way to it.
    pid = getattr(forkserver._forkserver, '_forkserver_pid', None)
    return pid if pid and state_of(pid) not in ('', 'Z') else 0


def server_ends(within_s: float) -> bool:
    """Wait for the end of the fork server, at most `within_s` in s; return whether none runs."""
    deadline = time.monotonic() + within_s
    while server_pid():
        if time.monotonic() > deadline:
            return False
        time.sleep(_SLICE_S)
    return True


def remove_socket() -> None:
    """Remove the socket of the fork server of a killed program, and its folder."""
    address = getattr(forkserver._forkserver, '_forkserver_address', None)
    with contextlib.suppress(OSError):
        if address:
            Path(address).unlink(missing_ok=True)
            Path(address).parent.rmdir()


def state_of(pid: int) -> str:
    """Return the letter of a process's state: Z after its end, T of a paused one, '' for none."""
    with contextlib.suppress(OSError):
        return Path(f'/proc/{pid}/stat').read_text(encoding='latin-1').rpartition(') ')[2][:1]
    return ''


def start_processes(
    processes: Sequence[ForkServerProcess], stopped: Callable[[], bool] = lambda: False
) -> None:
    """
    Have the fork server start all of these processes.

    Raise DdctError when it fails or takes longer than `START_S`, and KeyboardInterrupt when
    `stopped()` becomes true before. A server that does not start them by then is killed, and the
    next start has another one.
    """
    failures: list[BaseException] = []
    cancelled = threading.Event()

    def start() -> None:
        try:
            with _own_modules_alone():
                for process in processes:
                    if not cancelled.is_set():
                        process.start()
        except BaseException as error:
            failures.append(error)

    deadline = time.monotonic() + START_S
    start_server()
    # In a thread: the library waits without a limit for a server that imports or is paused.
    starting = threading.Thread(target=start, daemon=True)
    starting.start()
    started = False
    while not started:
        starting.join(_SLICE_S)
        started = not starting.is_alive()
        interrupted = stopped()
        if interrupted or time.monotonic() > deadline:
            cancelled.set()
            while starting.is_alive():
                stop_server()
                starting.join(_SLICE_S)
            if interrupted:
                raise KeyboardInterrupt
            raise DdctError(f'nodes could not be started within {START_S:g} s')
    for error in failures[:1]:
        raise _cannot_start(error) from error


def _cannot_start(error: BaseException) -> DdctError:
    if isinstance(error, EOFError | ConnectionError):
        why = 'the fork server, which forks them, was killed'
    else:
        why = str(error) or type(error).__name__
    # Its socket is in the folder for temporary files.
    advice = ': set TMPDIR to a folder with a shorter name' if 'AF_UNIX' in why else ''
    return DdctError(f'nodes cannot be started: {why}{advice}')


@contextlib.contextmanager
def _environment(given: dict[str, str]) -> Iterator[None]:
    """Set these variables for a process that is started meanwhile."""
    before = {name: os.environ[name] for name in given if name in os.environ}
    os.environ.update(given)
    try:
        yield
    finally:
        for name in given:
            os.environ.pop(name, None)
        os.environ.update(before)


@contextlib.contextmanager
def _own_modules_alone() -> Iterator[None]:
    """
    Hide from new processes what `multiprocessing` has them take over from this one.

    They would import the main module, which a script without a guard runs again, and search for
    modules in the current folder, as this process does after `python -m`.
    """
    main, path = sys.modules['__main__'], sys.path
    kept = os.environ.get('PYTHONPATH', '').split(os.pathsep)
    here = ('', str(Path.cwd()))
    sys.modules['__main__'] = types.ModuleType('__main__')
    sys.path = [each for each in path if each in kept or each not in here]
    try:
        yield
    finally:
        sys.modules['__main__'], sys.path = main, path
