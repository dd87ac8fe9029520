# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Campaigns whose processes die or are stopped: nothing is lost, and nothing computed twice."""

import os
import signal
import socket
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from pathlib import Path

import pytest
from refusals import refused
from support.complaints import assert_one_line
from support.processes import START_S, Program, Programs, children_of
from support.waiting import wait_until

from ddct_bringup.campaign import conduct, executors
from ddct_bringup.campaign.conduct import RESULTS, SHARDS
from ddct_bringup.programs import campaign
from ddct_bringup.run.output_folder import SUFFIX
from ddct_plant.base.errors import DdctError

RUNS = 10
SPEC = f"""\
controllers: [ls8]
clutch: stick_slip
grid: {{duration_s: [6]}}
random:
  samples: {RUNS}
  vary:
    vehicle.mass_kg: {{distribution: uniform, low: 1000, high: 2000}}
"""


class InThisProcess:
    """Workers as threads of this process."""

    count = 1

    def executor(self) -> ThreadPoolExecutor:
        return ThreadPoolExecutor(1)

    def require_alive(self) -> None:
        pass


@pytest.fixture
def spec(tmp_path: Path) -> Path:
    """Return a specification of runs that take a tenth of a second each."""
    file = tmp_path / 'mass.yaml'
    file.write_text(SPEC, encoding='utf-8')
    return file


def start_cluster(programs: Programs) -> tuple[str, list[Program]]:
    """Start a Dask scheduler and two workers; return its address, and the workers."""
    with socket.socket() as free:
        free.bind(('127.0.0.1', 0))
        port = free.getsockname()[1]
    address = f'tcp://127.0.0.1:{port}'
    place = ('--host', '127.0.0.1', '--no-dashboard')
    programs.start_module('distributed.cli.dask_scheduler', *place, '--port', str(port))
    worker = (address, *place, '--nthreads', '1', '--no-nanny')
    return address, [
        programs.start_module('distributed.cli.dask_worker', *worker) for _ in range(2)
    ]


def shards(out: Path) -> int:
    return len(list((out / SHARDS).glob('*.parquet')))


def wait_for_shards(out: Path, count: int) -> None:
    wait_until(lambda: shards(out) >= count, f'{count} shards', START_S)


def test_processes_that_die_and_ctrl_c_cost_a_campaign_only_time(
    spec: Path,
    tmp_path: Path,
    programs: Programs,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    whole, out = tmp_path / 'whole', tmp_path / 'out'
    address, workers = start_cluster(programs)
    arguments = (str(spec), '--out', str(out))
    local = programs.start_module('ddct_bringup.programs.campaign', *arguments, '--workers', '1')
    wait_for_shards(out, 1)
    (worker,) = children_of(local.process.pid)
    os.kill(worker, signal.SIGKILL)
    assert campaign.main([*arguments, '--resume']) == 1
    assert_one_line(
        capfd.readouterr().err, 'ddct campaign', f'process {local.process.pid} is writing there'
    )
    wait_for_shards(out, shards(out) + 1)
    local.send(signal.SIGINT)
    assert local.wait() == 130
    last = local.errors().splitlines()[-1]
    assert last == 'ddct campaign: interrupted; what is done stays: go on with --resume'
    assert not (out / RESULTS).exists()

    done = shards(out)
    assert done < RUNS - 2, 'the cluster has nothing left to do'
    killer = threading.Thread(target=_kill_when, args=(workers[0], out, done + 1))
    killer.start()
    assert campaign.main([*arguments, '--resume', '--scheduler', address]) == 0
    killer.join()
    monkeypatch.setattr(conduct, 'workers_of', lambda *_: nullcontext(InThisProcess()))
    assert campaign.main([str(spec), '--out', str(whole)]) == 0
    assert (out / RESULTS).read_bytes() == (whole / RESULTS).read_bytes()


def _kill_when(worker: Program, out: Path, count: int) -> None:
    """Kill a worker while shards are computed."""
    wait_for_shards(out, count)
    worker.send(signal.SIGKILL)


@pytest.mark.parametrize('address', ['tcp://127.0.0.1:9', 'no such place'])
def test_a_scheduler_that_is_not_there_is_reported_before_anything_is_written(
    spec: Path,
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    address: str,
) -> None:
    monkeypatch.setattr(executors, 'CONNECT_S', 0.5)
    out = tmp_path / 'out'
    assert campaign.main([str(spec), '--out', str(out), '--scheduler', address]) == 1
    assert_one_line(
        capfd.readouterr().err, 'ddct campaign', f'--scheduler {address}: no scheduler'
    )
    assert not out.exists()
    assert not list(tmp_path.glob(f'*{SUFFIX}'))


def test_an_address_of_another_server_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    def client(*_: object, **__: object) -> None:
        raise MemoryError('Unable to allocate 3.07 EiB')  # a web server's answer as a length

    monkeypatch.setattr('distributed.Client', client)
    with refused(DdctError, '--scheduler'):
        executors.DaskWorkers('tcp://web:80')


def test_without_dask_a_scheduler_cannot_be_used(
    spec: Path,
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, 'distributed', None)
    out = str(tmp_path / 'out')
    assert campaign.main([str(spec), '--out', out, '--scheduler', 'tcp://127.0.0.1:9']) == 1
    words = ('--scheduler needs Dask', 'pip install distributed')
    assert_one_line(capfd.readouterr().err, 'ddct campaign', *words)


@pytest.mark.parametrize(
    ('options', 'words'),
    [
        (['--workers', '0'], 'workers is 0: give 1 or more'),
        (['--resume'], 'there is nothing to go on with'),
        (['--limits', 'absent.yaml'], 'limits absent.yaml: cannot be read'),
    ],
)
def test_options_that_cannot_be_used_are_reported(
    spec: Path,
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
    options: list[str],
    words: str,
) -> None:
    assert campaign.main([str(spec), '--out', str(tmp_path / 'out'), *options]) == 1
    assert_one_line(capfd.readouterr().err, 'ddct campaign', words)
