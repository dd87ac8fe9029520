# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
What programs need of the operating system, on Linux and elsewhere.

Other modules of headless programs use what Python has everywhere. The graph of ROS nodes runs on
Linux alone: its modules ask Linux themselves.
"""

import os
import signal
import sys
import threading
import types
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ddct_plant.base.errors import DdctError

KILLED = frozenset({signal.SIGTERM, getattr(signal, 'SIGKILL', signal.SIGTERM)})
"""Signals by which somebody else has ended a process."""
_PROCESSOR = Path('/proc/cpuinfo')
_SET_PARENT_DEATH_SIGNAL = 1
_main_module = threading.Lock()


def is_linux() -> bool:
    """Return whether this is Linux."""
    return sys.platform == 'linux'


def core_count() -> int:
    """Return the number of cores that this process may use, elsewhere that of the machine."""
    if is_linux():
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def processor_features() -> set[str]:
    """Return the features of an x86-64 processor by their names in Linux, elsewhere none."""
    if is_linux() and os.uname().machine == 'x86_64':
        return {*_processor_line('flags').split()}
    return set()


def processor_name() -> str:
    """Return the name of the processor, that of its architecture where nothing tells more."""
    import platform

    return (_processor_line('model name') if is_linux() else '') or platform.machine()


def _processor_line(name: str) -> str:
    """Return what Linux says of the first processor under that name, '' for nothing."""
    with _PROCESSOR.open(encoding='utf-8', errors='replace') as lines:
        values = (line.partition(':')[2] for line in lines if line.startswith(name))
        return next(values, '').strip()


def c_library() -> str:
    """Return name and version of the C library, elsewhere of the system that it belongs to."""
    import platform

    named = platform.libc_ver() if is_linux() else (platform.system(), platform.release())
    return ' '.join(named)


def is_running(process: int) -> bool:
    """Return whether a process runs, by its id; True where that cannot be asked."""
    return not is_linux() or Path('/proc', str(process)).exists()


def open_files_stay() -> bool:
    """Return whether a file that a process has open cannot be removed, as on Windows."""
    return sys.platform == 'win32'


def flush_c_output() -> None:
    """Write what code in C has printed and not written yet; elsewhere C does so at its end."""
    if is_linux():
        _libc().fflush(None)


def end_at_exit() -> None:
    """
    Let exit() in C end this process at once, with what C has printed and its exit code (Linux).

    Else the libraries of the program clean up: they may wait for threads that a fork does not
    have, or crash beside those that still run.
    """
    if is_linux():
        libc = _libc()
        # The handlers run in the reverse order.
        libc.on_exit(libc._exit, None)
        libc.__cxa_atexit(libc.fflush, None, None)


def end_with(parent: int) -> None:
    """
    End this process when its parent ends, whose id is `parent`; at once where it has ended.

    Elsewhere than on Linux a thread waits for that, which code that keeps the interpreter's lock
    delays.
    """
    if is_linux():
        _libc().prctl(_SET_PARENT_DEATH_SIGNAL, signal.SIGKILL)
        # The kernel sends no signal for an end before this call.
        if os.getppid() != parent:
            os.kill(os.getpid(), signal.SIGKILL)
    else:
        threading.Thread(target=_end_after_parent, daemon=True).start()


def _end_after_parent() -> None:
    from multiprocessing import parent_process

    if parent := parent_process():
        parent.join()
        os._exit(1)


def _libc() -> Any:
    import ctypes

    return ctypes.CDLL(None)


def process_context() -> Any:
    """
    Return how multiprocessing starts processes here: as forks on Linux, elsewhere anew.

    A fork has all that this process has imported and built. A new process has what it is given as
    `Sent`, within `main_left_out`.
    """
    import multiprocessing

    return multiprocessing.get_context('fork' if is_linux() else 'spawn')


class Sent:
    """A value for another process: as it is in a new fork, else pickled."""

    def __init__(self, value: Any) -> None:
        """Hold a value of any type."""
        self.value = value

    def __reduce__(self) -> tuple[Any, ...]:
        """
        Pickle the value, for a process that is no fork by cloudpickle: functions and scripts too.

        Raise DdctError for one that cannot be pickled.
        """
        if is_linux():
            return Sent, (self.value,)
        import cloudpickle

        before = [(take, state()) for state, take in _carried]
        try:
            return _received, (cloudpickle.dumps(before), cloudpickle.dumps(self.value))
        except Exception as error:  # of any class of the user
            raise DdctError(
                f'cannot be sent to another process ({error}): on this system a controller has to '
                'be picklable'
            ) from error


_carried: list[tuple[Callable[[], Any], Callable[[Any], None]]] = []


def carry(state: Callable[[], Any], take: Callable[[Any], None]) -> None:
    """Let a new process call `take` with the result of `state` here before it gets a value."""
    _carried.append((state, take))


def _received(before: bytes, pickled: bytes) -> Sent:
    import cloudpickle

    for take, state in cloudpickle.loads(before):
        take(state)
    return Sent(cloudpickle.loads(pickled))


@contextmanager
def main_left_out() -> Iterator[None]:
    """
    Let new processes that are started within not run the script of this program once more.

    Else a script on Windows and macOS would need `if __name__ == '__main__':` around it. A fork
    runs no script.
    """
    if is_linux():
        yield
        return
    with _main_module:
        main = sys.modules['__main__']
        sys.modules['__main__'] = types.ModuleType('__main__')
        try:
            yield
        finally:
            sys.modules['__main__'] = main
