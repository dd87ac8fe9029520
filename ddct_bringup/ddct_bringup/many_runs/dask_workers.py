# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Workers of a Dask cluster, by its own executor."""

import math
import time
from collections.abc import Sequence
from concurrent.futures import CancelledError, Future
from typing import Any

from ddct_bringup.many_runs.local_workers import Ended, Submit
from ddct_bringup.many_runs.work import Work
from ddct_plant.base.errors import FOREIGN_FAILURES, DdctError

CONNECT_S = 10.0
"""Longest time in s for the connection to a scheduler."""
LOST_S = 30.0
"""Longest time in s without any worker in a cluster."""
REFRESH_S = 1.0
"""Time in s for which the list of workers serves: the scheduler computes it for each request."""


class DaskWorkers:
    """The workers of a Dask cluster."""

    ahead = 2

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

    def begin(self, work: Work[Any, Any]) -> Submit:
        """Return the function that hands over blocks; that of a failed worker goes to another."""
        executor = self._client.get_executor(pure=False)

        def submit(items: Sequence[Any]) -> 'Future[Any]':
            future = executor.submit(work.of_block, items)
            future.add_done_callback(self._heard_of)
            return future

        return submit

    def _heard_of(self, _: object) -> None:
        """Note that a worker has ended a block, with a result or by its death."""
        self._lost_since = None

    def alone(self) -> 'DaskWorkers':
        """Return the same workers: a cluster starts another one for each that ends."""
        return self

    def ended(self, error: BaseException) -> Ended | None:
        """
        Return how a block was lost with the error of a future; None for another error.

        A block that ends several workers is an error: each computes others beside it.
        """
        if isinstance(error, CancelledError):  # as where the connection was lost
            return Ended('', by_itself=False)
        return None

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
