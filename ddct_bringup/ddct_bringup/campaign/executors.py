# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Executors that compute shards: processes of this machine, or a Dask cluster."""

import multiprocessing
import os
import time
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager

from ddct_plant.base.errors import FOREIGN_FAILURES, DdctError, ParameterError
from ddct_plant.program.workers import begin_worker

CONNECT_S = 10.0
"""Longest time in s for the connection to a scheduler."""
LOST_S = 30.0
"""Longest time in s without any worker in a cluster."""
_ONE_THREAD = dict.fromkeys(('OPENBLAS_NUM_THREADS', 'OMP_NUM_THREADS', 'MKL_NUM_THREADS'), '1')
"""Environment of the workers: one thread, so that sums have one order and workers do not wait."""


class LocalWorkers:
    """Processes of this machine, each with one numerics thread; `count` at once."""

    def __init__(self, count: int | None = None) -> None:
        """Use `count` workers, by default one per core; raise ParameterError for less than one."""
        if count is not None and count < 1:
            raise ParameterError(f'workers is {count}: give 1 or more')
        self.count = count or len(os.sched_getaffinity(0))
        self._pool: ProcessPoolExecutor | None = None

    def executor(self) -> Executor:
        """Return a new pool; a former pool has broken."""
        self.close()
        # Each worker is a new interpreter: a fork would inherit the locks of threads and of BLAS.
        context = multiprocessing.get_context('spawn')
        self._pool = ProcessPoolExecutor(self.count, context, begin_worker)
        return self._pool

    def require_alive(self) -> None:
        """Do nothing: a pool whose processes die breaks without a check."""

    def close(self) -> None:
        """Kill the processes; unfinished results are lost."""
        if self._pool is None:
            return
        processes = list((self._pool._processes or {}).values())
        self._pool.shutdown(wait=False, cancel_futures=True)
        for process in processes:
            process.kill()
        for process in processes:
            process.join()
        self._pool = None


class DaskWorkers:
    """The workers of a Dask cluster."""

    def __init__(self, address: str) -> None:
        """Connect to a scheduler; raise DdctError for an address without one."""
        try:
            from distributed import Client
        except ImportError as error:
            raise DdctError(
                f'--scheduler needs Dask ({error}): pip install distributed'
            ) from error
        try:
            self._client = Client(address, timeout=CONNECT_S, set_as_default=False)
        except FOREIGN_FAILURES as error:  # also where another kind of server answers
            raise DdctError(
                f'--scheduler {address}: no scheduler answers there ({error}): start one, or '
                'leave the option out'
            ) from error
        self._address = address
        self._lost_since: float | None = None

    @property
    def count(self) -> int:
        """Number of threads of all workers."""
        workers = self._client.scheduler_info(n_workers=-1)['workers'].values()
        return sum(worker['nthreads'] for worker in workers) or 1

    def executor(self) -> Executor:
        """Return an executor of the cluster; the task of a failed worker goes to another one."""
        return self._client.get_executor(pure=False)

    def require_alive(self) -> None:
        """Raise DdctError when the scheduler is gone, or has had no worker for `LOST_S`."""
        if self._client.status != 'running':
            raise DdctError(f'--scheduler {self._address}: the scheduler has gone')
        if self._client.scheduler_info(n_workers=-1)['workers']:
            self._lost_since = None
            return
        now = time.monotonic()
        self._lost_since = now if self._lost_since is None else self._lost_since
        if now - self._lost_since > LOST_S:
            raise DdctError(f'--scheduler {self._address}: it has no worker: start one')

    def close(self) -> None:
        """Disconnect; the cluster drops tasks that have not started."""
        self._client.close(timeout=CONNECT_S)


Workers = LocalWorkers | DaskWorkers
"""Executor of shards, and its number of workers."""


@contextmanager
def workers_of(count: int | None, scheduler: str | None) -> Iterator[Workers]:
    """Yield the workers of a scheduler address, or local ones, and close them."""
    workers: Workers = DaskWorkers(scheduler) if scheduler else LocalWorkers(count)
    before = {name: os.environ.get(name) for name in _ONE_THREAD}
    os.environ.update(_ONE_THREAD)
    try:
        yield workers
    finally:
        for name, value in before.items():
            os.environ.pop(name, None)
            if value is not None:
                os.environ[name] = value
        workers.close()
