# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A Dask cluster of processes on this machine."""

import socket

import pytest
from waiting import WITHIN_S

from ddct_bringup.many_runs import dask_workers
from support.processes import Program, Programs


def start_cluster(
    programs: Programs, monkeypatch: pytest.MonkeyPatch, *, workers: int
) -> tuple[str, list[Program]]:
    """
    Start a Dask scheduler and its workers; return its address, and the workers.

    Campaigns of the test wait for them as long as a busy machine may take to start them.
    """
    monkeypatch.setattr(dask_workers, 'CONNECT_S', WITHIN_S)
    monkeypatch.setattr(dask_workers, 'LOST_S', WITHIN_S)
    with socket.socket() as free:
        free.bind(('127.0.0.1', 0))
        port = free.getsockname()[1]
    address = f'tcp://127.0.0.1:{port}'
    place = ('--host', '127.0.0.1', '--no-dashboard')
    programs.start_module('distributed.cli.dask_scheduler', *place, '--port', str(port))
    worker = (address, *place, '--nthreads', '1', '--no-nanny')
    return address, [
        programs.start_module('distributed.cli.dask_worker', *worker) for _ in range(workers)
    ]
