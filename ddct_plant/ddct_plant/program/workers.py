# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Work shared among processes of this machine, forked from this one.

A worker has all that the program has imported and built, so it starts at once, and the work may
refer to any object. It uses one thread for numerics.
"""

import gc
import multiprocessing
import os
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing, contextmanager
from typing import Any, TypeVar

from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.program.arithmetic import limit_threads
from ddct_plant.program.signals import deferred_signals, obey_parent

_LARGEST_CHUNK = 16
"""Largest number of results that a worker sends at once."""
_CHUNKS_EACH = 8
"""Least number of chunks of a worker, where there is enough work, so that all end together."""
Result = TypeVar('Result')


class WorkerPool:
    """Processes of this machine, each with one numerics thread; `count` at once."""

    def __init__(self, count: int | None = None, work: Callable[[Any], Any] | None = None) -> None:
        """
        Use `count` workers, by default one per core; raise ParameterError for less than one.

        `work` is the function of `in_processes` and `submit`; without it work is submitted to
        `executor`.
        """
        self.count = worker_count(count)
        self._work = work
        self._pool: ProcessPoolExecutor | None = None

    def executor(self) -> Executor:
        """Return a new pool; a former pool has broken."""
        self.close()
        context = multiprocessing.get_context('fork')
        self._not_ours = {*multiprocessing.active_children()}
        self._pool = ProcessPoolExecutor(self.count, context, _begin, (os.getpid(), self._work))
        return self._pool

    def submit(self, argument: Any) -> 'Future[Any]':
        """Return the future of `work(argument)`; processes start with the first call and last."""
        pool = self._pool or self.executor()
        return pool.submit(_result, argument)

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
            processes = {*multiprocessing.active_children()} - self._not_ours
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
            self._pool = None


def worker_count(count: int | None) -> int:
    """Return a number of workers, by default that of the cores; ParameterError for less than 1."""
    if count is not None and count < 1:
        raise ParameterError(f'workers is {count}: give 1 or more')
    return count or len(os.sched_getaffinity(0))


@contextmanager
def in_processes(
    work: Callable[[int], Result],
    count: int,
    workers: int | None = None,
    *,
    chunk: int | None = None,
) -> Iterator[Iterator[Result]]:
    """
    Yield the results of `work(0)` to `work(count - 1)`, in this order, computed as they are taken.

    `workers` is the number of processes, by default that of the cores; 1 means this process.
    `chunk` is the number of results that a worker sends together. Only results are passed between
    processes, so `work` may be any function. The block ends with DdctError when a worker was
    killed.
    """
    workers = min(worker_count(workers), count)
    if workers < 2:
        yield map(work, range(count))
        return
    with closing(WorkerPool(workers, work)) as pool:
        chunk = chunk or max(1, min(_LARGEST_CHUNK, count // (_CHUNKS_EACH * workers)))
        # A worker may die while work is handed out, or while the caller takes a result.
        try:
            yield pool.executor().map(_result, range(count), chunksize=chunk)
        except BrokenProcessPool as error:
            raise DdctError(
                'a process that simulates was killed: free some memory if it ran out, and start '
                'again'
            ) from error


_work: Callable[[Any], Any] | None = None
"""Function that a forked worker computes."""


def _begin(parent: int, work: Callable[[Any], Any] | None) -> None:
    """Prepare a worker of the program `parent`."""
    global _work
    _work = work
    obey_parent(parent)
    # Collecting what the program has imported would take as long as many runs, and copy it.
    gc.freeze()
    limit_threads(1)


def _result(argument: Any) -> Any:
    """Return the result of a worker's function; the function is there since the fork."""
    assert _work is not None
    return _work(argument)
