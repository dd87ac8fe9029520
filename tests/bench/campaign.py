# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Time of campaigns: predictive control with a stick-slip clutch, and Dask with two workers.

Processor time is measured too, since wall time depends on the other programs of the machine.
"""

import os
import resource
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pyarrow.parquet as parquet

MPC3_RUNS, MPC3_GOAL_S = 1000, 60.0
DASK_GOAL = 1.6
_DASK_RUNS = 400
_START_S = 60.0
_SPEC = """\
controllers: [mpc3]
clutch: stick_slip
random:
  samples: {runs}
  vary:
    wear_gain: {{distribution: uniform, low: 0.8, high: 1.2}}
"""


def measure(runs: int = MPC3_RUNS, dask_runs: int = _DASK_RUNS) -> dict[str, Any]:
    """Return the times in s of a campaign of mpc3 here, and of a shorter one with Dask workers."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        wall_s, cpu_s = _campaign(place / 'here', runs, '--workers', '2')
        with _cluster(1) as address:
            _campaign(place / 'warm', 8, '--scheduler', address)
            one_s, _ = _campaign(place / 'one', dask_runs, '--scheduler', address)
        with _cluster(2) as address:
            _campaign(place / 'warm-2', 8, '--scheduler', address)
            two_s, _ = _campaign(place / 'two', dask_runs, '--scheduler', address)
    return {
        'mpc3_runs': runs,
        'mpc3_s': wall_s,
        'mpc3_cpu_ms': 1e3 * cpu_s / runs,
        'dask_runs': dask_runs,
        'dask_one_s': one_s,
        'dask_two_s': two_s,
        'dask_ratio': one_s / two_s,
    }


def print_table(results: dict[str, Any]) -> None:
    """Print the results of `measure`."""
    thousand_s = results['mpc3_s'] * MPC3_RUNS / results['mpc3_runs']
    print(
        f'campaign: {results["mpc3_runs"]} stick_slip runs of mpc3, two processes: '
        f'{results["mpc3_s"]:.1f} s (1000: {thousand_s:.1f} s, goal {MPC3_GOAL_S:g}: '
        f'{"met" if thousand_s < MPC3_GOAL_S else "MISSED"}), '
        f'{results["mpc3_cpu_ms"]:.1f} ms of processor time a run'
    )
    ratio = results['dask_ratio']
    print(
        f'campaign: {results["dask_runs"]} of them on one Dask worker '
        f'{results["dask_one_s"]:.1f} s, on two {results["dask_two_s"]:.1f} s: {ratio:.2f} times '
        f'as fast (goal {DASK_GOAL:g}: '
        f'{"met" if ratio >= DASK_GOAL else "MISSED"})'
    )


def _campaign(out: Path, runs: int, *options: str) -> tuple[float, float]:
    """Carry out a campaign; return its wall time and its processes' processor time in s."""
    spec = out.with_suffix('.yaml')
    spec.write_text(_SPEC.format(runs=runs), encoding='utf-8')
    before = _children_s()
    started = time.perf_counter()
    subprocess.run(
        [sys.executable, '-m', 'ddct_bringup.programs.campaign', spec, '--out', out, *options],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    took = time.perf_counter() - started
    assert parquet.read_metadata(out / 'results.parquet').num_rows == runs
    return took, _children_s() - before


def _children_s() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


@contextmanager
def _cluster(workers: int) -> Iterator[str]:
    """Run a Dask cluster of workers with one thread each; yield the address of its scheduler."""
    with socket.socket() as free:
        free.bind(('127.0.0.1', 0))
        port = free.getsockname()[1]
    address = f'tcp://127.0.0.1:{port}'
    common = ('--host', '127.0.0.1', '--no-dashboard')
    worker = ('dask_worker', address, *common, '--nthreads', '1', '--no-nanny')
    commands = [('dask_scheduler', *common, '--port', str(port)), *([worker] * workers)]
    environment = {**os.environ, 'OPENBLAS_NUM_THREADS': '1'}
    processes = [
        subprocess.Popen(
            [sys.executable, '-m', f'distributed.cli.{command[0]}', *command[1:]],
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        for command in commands
    ]
    try:
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


if __name__ == '__main__':
    print_table(measure(*(int(each) for each in sys.argv[1:])))
