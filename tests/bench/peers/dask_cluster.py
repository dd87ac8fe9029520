# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A Dask cluster on this machine."""

import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from bench.skeleton.interruption import uninterrupted

_START_S = 60.0


@contextmanager
def cluster(workers: int) -> Iterator[str]:
    """Run a Dask cluster of workers with one thread each; yield the address of its scheduler."""
    with socket.socket() as free:
        free.bind(('127.0.0.1', 0))
        port = free.getsockname()[1]
    address = f'tcp://127.0.0.1:{port}'
    common = ('--host', '127.0.0.1', '--no-dashboard')
    worker = ('dask_worker', address, *common, '--nthreads', '1', '--no-nanny')
    commands = [('dask_scheduler', *common, '--port', str(port)), *([worker] * workers)]
    environment = {**os.environ, 'OPENBLAS_NUM_THREADS': '1'}
    processes: list[subprocess.Popen[bytes]] = []
    try:
        for command in commands:
            with uninterrupted():
                processes.append(
                    subprocess.Popen(
                        [sys.executable, '-m', f'distributed.cli.{command[0]}', *command[1:]],
                        env=environment,
                        stdout=subprocess.DEVNULL,
                        stderr=subprocess.DEVNULL,
                    )
                )
        _wait_for_workers(address, workers)
        yield address
    finally:
        for process in processes:
            process.kill()
        for process in processes:
            process.wait()


def _wait_for_workers(address: str, count: int) -> None:
    from distributed import Client

    with Client(address, timeout=_START_S, set_as_default=False) as client:
        client.wait_for_workers(count, timeout=_START_S)
