# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Campaigns whose processes die or are stopped: nothing is lost, and nothing computed twice."""

import os
import signal
import sys
from pathlib import Path

import pyarrow.parquet as parquet
import pytest
from refusals import refused
from support.complaints import assert_one_line
from support.processes import Programs, children_of
from support.short_campaign import RUNS, shards, wait_for_shards, write_specification

from ddct_bringup.campaign import conduct
from ddct_bringup.campaign.conduct import RESULTS
from ddct_bringup.many_runs import dask_workers
from ddct_bringup.many_runs.local_workers import ThisProcess
from ddct_bringup.programs import campaign
from ddct_bringup.run.output_folder import SUFFIX
from ddct_plant.base.errors import DdctError


@pytest.fixture
def spec(tmp_path: Path) -> Path:
    """Return a specification of runs that take a tenth of a second each."""
    return write_specification(tmp_path)


def test_a_worker_that_dies_and_ctrl_c_cost_a_campaign_only_time(
    spec: Path,
    tmp_path: Path,
    programs: Programs,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """That a cluster goes on with it, and loses a worker, is in tests/nightly."""
    whole, out = tmp_path / 'whole', tmp_path / 'out'
    arguments = (str(spec), '--out', str(out))
    local = programs.start_module('ddct_bringup.programs.campaign', *arguments, '--workers', '1')
    wait_for_shards(out, 1)
    (worker,) = children_of(local.process.pid)
    os.kill(worker, signal.SIGKILL)
    wait_for_shards(out, shards(out) + 1)
    local.send(signal.SIGSTOP)  # it ends no run while another is refused
    assert campaign.main([*arguments, '--resume']) == 1
    assert_one_line(
        capfd.readouterr().err, 'ddct campaign', f'process {local.process.pid} is writing there'
    )
    local.send(signal.SIGINT)
    local.send(signal.SIGCONT)
    assert local.wait() == 130
    last = local.errors().splitlines()[-1]
    assert last == 'ddct campaign: interrupted; what is done stays: go on with --resume'
    assert not (out / RESULTS).exists()

    assert shards(out) < RUNS, 'there is nothing left to do'
    monkeypatch.setattr(conduct, 'workers_of', lambda *_: ThisProcess())
    assert campaign.main([*arguments, '--resume']) == 0
    assert campaign.main([str(spec), '--out', str(whole)]) == 0
    ours, expected = (parquet.read_table(each / RESULTS).to_pylist() for each in (out, whole))
    assert ours == expected, 'rows'
    assert (out / RESULTS).read_bytes() == (whole / RESULTS).read_bytes()


@pytest.mark.parametrize('address', ['tcp://127.0.0.1:9', 'no such place'])
def test_a_scheduler_that_is_not_there_is_reported_before_anything_is_written(
    spec: Path,
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    address: str,
) -> None:
    monkeypatch.setattr(dask_workers, 'CONNECT_S', 0.5)
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
        dask_workers.DaskWorkers('tcp://web:80')


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
