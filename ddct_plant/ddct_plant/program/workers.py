# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Work shared among forked processes of this machine; it may refer to any object."""

import ctypes
import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

from ddct_plant.base.errors import DdctError
from ddct_plant.program.supervision import end_with_parent

_SET_THREADS = (
    'openblas_set_num_threads',
    'scipy_openblas_set_num_threads',
    'scipy_openblas_set_num_threads64_',
)
"""Names of the function that sets the threads of OpenBLAS, by build of the library."""
_LARGEST_CHUNK = 16
"""Largest number of results that a worker sends at once."""
_CHUNKS_EACH = 8
"""Least number of chunks of a worker, where there is enough work, so that all end together."""
Result = TypeVar('Result')


@contextmanager
def in_processes(
    work: Callable[[int], Result], count: int, workers: int | None = None
) -> Iterator[Iterator[Result]]:
    """
    Yield the results of `work(0)` to `work(count - 1)`, in this order, computed as they are taken.

    `workers` is the number of processes, by default that of the cores; 1 means this process.
    Only results are passed between processes, so `work` may be any function. Taking a result
    raises DdctError when a worker was killed.
    """
    workers = min(workers or len(os.sched_getaffinity(0)), count)
    if workers < 2:
        yield map(work, range(count))
        return
    context = multiprocessing.get_context('fork')
    with ProcessPoolExecutor(workers, context, _begin, (work,)) as pool:
        chunk = max(1, min(_LARGEST_CHUNK, count // (_CHUNKS_EACH * workers)))
        results = pool.map(_at, range(count), chunksize=chunk)
        try:
            yield _taken(results)
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def _taken(results: Iterator[Result]) -> Iterator[Result]:
    try:
        yield from results
    except BrokenProcessPool as error:
        raise DdctError(
            'a process that simulates was killed: free some memory if it ran out, and start again'
        ) from error


_work: Callable[[int], Any]
"""Function that a forked worker computes."""


def _begin(work: Callable[[int], Any]) -> None:
    global _work
    _work = work
    begin_worker()
    one_numeric_thread()


def begin_worker() -> None:
    """Prepare a worker: it ignores Ctrl-C, and is killed when the program ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    end_with_parent(signal.SIGKILL)


def one_numeric_thread() -> None:
    """
    Let the OpenBLAS libraries of numpy and scipy use one thread, as `ddct` does by its variable.

    Matrices are small: more threads only wait for one another, and may change the rounding.
    """
    loaded = Path('/proc/self/maps').read_text(encoding='utf-8').split()
    for name in {word for word in loaded if '/' in word and 'openblas' in Path(word).name}:
        library = ctypes.CDLL(name)
        for function in _SET_THREADS:
            if hasattr(library, function):
                getattr(library, function)(1)


def _at(index: int) -> Any:
    return _work(index)
