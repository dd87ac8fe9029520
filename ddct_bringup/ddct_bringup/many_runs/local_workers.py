# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Workers of this machine: other processes, or this process itself.

On Linux they are forks: each has all that the program has imported and built, so it starts at
once, and the work may refer to any object. Elsewhere they are new and the work is pickled for
them. Each uses one thread for numerics.
"""

import faulthandler
import gc
import multiprocessing
import os
import signal
from collections.abc import Callable, Sequence
from concurrent.futures import BrokenExecutor, Future, ProcessPoolExecutor
from multiprocessing.process import BaseProcess
from typing import Any, NamedTuple

from ddct_bringup.many_runs.work import Work
from ddct_plant.base.errors import ParameterError
from ddct_plant.program.arithmetic import limit_threads
from ddct_plant.program.operating_system import (
    KILLED,
    Sent,
    core_count,
    main_left_out,
    process_context,
)
from ddct_plant.program.signals import deferred_signals, obey_parent

Submit = Callable[[Sequence[Any]], 'Future[Any]']
"""Hand over a block; the future has its result."""


class Ended(NamedTuple):
    """How a process has ended that did not give its result."""

    how: str
    """Clause, such as "its process crashed (SIGSEGV)"; empty if the work has no part in it."""
    by_itself: bool
    """Whether the work ended it; else somebody may have killed it, as for memory."""


class LocalWorkers:
    """Processes of this machine; `count` at once."""

    ahead = 2
    """Number of blocks handed over per worker, so that none waits for the next."""

    def __init__(self, count: int | None = None) -> None:
        """Use `count` workers, by default one per core; raise ParameterError for less than 1."""
        self.count = worker_count(count)
        self._pool: ProcessPoolExecutor | None = None
        self._work: Work[Any, Any] | None = None
        self._not_ours: set[BaseProcess] = set()
        self._processes: set[BaseProcess] = set()

    def begin(self, work: Work[Any, Any]) -> Submit:
        """Return the function that hands over blocks; processes last until other work or close."""
        if self._pool is None or self._work is not work:
            self.close()
            self._not_ours = {*multiprocessing.active_children()}
            given = os.getpid(), Sent(work)
            self._pool = ProcessPoolExecutor(self.count, process_context(), _begin, given)
            self._work = work
        return self._submit

    def _submit(self, items: Sequence[Any]) -> 'Future[Any]':
        assert self._pool is not None
        with main_left_out():
            future = self._pool.submit(_of_block, Sent(items))
        self._processes |= {*multiprocessing.active_children()} - self._not_ours
        return future

    def alone(self) -> 'LocalWorkers':
        """Return one process, in which a block runs that may end it; all others are closed."""
        self.close()
        return LocalWorkers(1)

    def ended(self, error: BaseException) -> Ended | None:
        """Return how a process has ended with the error of a future; None for another error."""
        if not isinstance(error, BrokenExecutor):
            return None
        processes = self._processes
        self.close()
        codes = [each.exitcode for each in processes if each.exitcode is not None]
        # Python ends the others by SIGTERM when one has ended.
        own = [code for code in codes if code != -signal.SIGTERM] or codes
        if not own:
            return Ended('its process was killed', by_itself=False)
        code = own[0]
        if code >= 0:
            return Ended(f'its process ended with exit code {code}', by_itself=True)
        name = signal.Signals(-code).name
        if -code in KILLED:
            return Ended(f'its process was killed ({name})', by_itself=False)
        return Ended(f'its process crashed ({name})', by_itself=True)

    def require_alive(self) -> None:
        """Do nothing: a pool whose processes die breaks without a check."""

    def close(self) -> None:
        """
        Kill the processes; unfinished results are lost.

        A second Ctrl-C waits until they have ended: at its end Python waits for all of them.
        """
        if self._pool is None:
            return
        with deferred_signals():
            # The pool does not know one whose start was interrupted.
            processes = self._processes | {*multiprocessing.active_children()} - self._not_ours
            # shutdown() drops this thread, and cannot wait for it before the processes are killed.
            manager = getattr(self._pool, '_executor_manager_thread', None)
            self._pool.shutdown(wait=False, cancel_futures=True)
            for process in processes:
                process.kill()
            for process in processes:
                # The pool's own thread may take the exit status first: join() then returns early.
                while process.is_alive():
                    process.join(0.01)
            # Python wakes the thread at exit, by a pipe that the thread may just have closed.
            if manager is not None and manager.is_alive():
                manager.join()
            self._pool, self._processes = None, set()


class ThisProcess:
    """The worker that is this process itself."""

    count, ahead = 1, 1

    def begin(self, work: Work[Any, Any]) -> Submit:
        """Return the function that does a block at once."""

        def submit(items: Sequence[Any]) -> 'Future[Any]':
            future: Future[Any] = Future()
            try:
                future.set_result(work.of_block(items))
            except Exception as error:
                future.set_exception(error)
            return future

        return submit

    def alone(self) -> 'ThisProcess':
        """Return this process."""
        return self

    def ended(self, error: BaseException) -> Ended | None:
        """Return None: what ends this process ends the program."""
        del error
        return None

    def require_alive(self) -> None:
        """Do nothing."""

    def close(self) -> None:
        """Do nothing."""


def worker_count(count: int | None) -> int:
    """Return a number of workers, by default that of the cores; ParameterError for less than 1."""
    if count is not None and count < 1:
        raise ParameterError(f'workers is {count}: give 1 or more')
    return count or core_count()


def is_worker() -> bool:
    """Return whether this process is itself one of `LocalWorkers`."""
    return _work is not None


_work: Work[Any, Any] | None = None
"""Work of a worker, in its process."""


def _begin(parent: int, work: Sent) -> None:
    """Prepare a worker of the program `parent`."""
    global _work
    _work = work.value
    obey_parent(parent)
    faulthandler.disable()  # a crash becomes the reason of an item, in one line
    # Collecting what the program has imported would take as long as many runs, and copy it.
    gc.freeze()
    limit_threads(1)


def _of_block(items: Sent) -> Any:
    """Return the result of a block of the worker's work."""
    assert _work is not None
    return _work.of_block(items.value)
