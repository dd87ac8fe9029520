# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Executors that compute shards: processes of this machine, or a Dask cluster."""

import math
import time
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import closing, contextmanager

from ddct_plant.base.errors import FOREIGN_FAILURES, DdctError
from ddct_plant.program.workers import WorkerPool

CONNECT_S = 10.0
"""Longest time in s for the connection to a scheduler."""
LOST_S = 30.0
"""Longest time in s without any worker in a cluster."""
REFRESH_S = 1.0
"""Time in s for which the list of workers serves: the scheduler computes it for each request."""


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
                'leave the option out',
                key='--scheduler',
            ) from error
        self._address = address
        self._lost_since: float | None = None
        self._threads: list[int] = []
        self._read_at = -math.inf

    @property
    def count(self) -> int:
        """Number of threads of all workers."""
        return sum(self._threads_of_workers()) or 1

    def executor(self) -> Executor:
        """Return an executor of the cluster; the task of a failed worker goes to another one."""
        return self._client.get_executor(pure=False)

    def require_alive(self) -> None:
        """Raise DdctError when the scheduler is gone, or has had no worker for `LOST_S`."""
        if self._client.status != 'running':
            raise DdctError(f'--scheduler {self._address}: the scheduler has gone')
        if self._threads_of_workers():
            self._lost_since = None
            return
        now = time.monotonic()
        self._lost_since = now if self._lost_since is None else self._lost_since
        if now - self._lost_since > LOST_S:
            raise DdctError(f'--scheduler {self._address}: it has no worker: start one')

    def _threads_of_workers(self) -> list[int]:
        """Return the number of threads of each worker."""
        now = time.monotonic()
        if now - self._read_at >= REFRESH_S:
            workers = self._client.scheduler_info(n_workers=-1)['workers'].values()
            self._threads, self._read_at = [worker['nthreads'] for worker in workers], now
        return self._threads

    def close(self) -> None:
        """Disconnect; the cluster drops tasks that have not started."""
        self._client.close(timeout=CONNECT_S)


Workers = WorkerPool | DaskWorkers
"""Executor of shards, and its number of workers."""


@contextmanager
def workers_of(count: int | None, scheduler: str | None) -> Iterator[Workers]:
    """Yield the workers of a scheduler address, or local ones, and close them."""
    workers: Workers = DaskWorkers(scheduler) if scheduler else WorkerPool(count)
    with closing(workers):
        yield workers
