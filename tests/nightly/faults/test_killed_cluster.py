# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A Dask cluster that loses a worker in the middle of a campaign."""

import signal
import threading
from pathlib import Path

import pytest
from support.dask_cluster import start_cluster
from support.processes import Program, Programs
from support.short_campaign import RUNS, shards, wait_for_shards, write_specification

from ddct_bringup.campaign import conduct
from ddct_bringup.campaign.conduct import RESULTS
from ddct_bringup.many_runs.local_workers import ThisProcess
from ddct_bringup.programs import campaign


def test_a_cluster_goes_on_with_a_campaign_and_a_worker_that_dies_costs_only_time(
    tmp_path: Path,
    programs: Programs,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    whole, out = tmp_path / 'whole', tmp_path / 'out'
    spec = write_specification(tmp_path)
    arguments = (str(spec), '--out', str(out))
    local = programs.start_module('ddct_bringup.programs.campaign', *arguments, '--workers', '1')
    wait_for_shards(out, 1)
    local.send(signal.SIGINT)
    assert local.wait() == 130
    assert shards(out) < RUNS, 'the cluster has nothing left to do'
    address, workers = start_cluster(programs, monkeypatch, workers=2)
    killer = threading.Thread(target=_kill_when, args=(workers[0], out, shards(out) + 1))
    killer.start()
    assert campaign.main([*arguments, '--resume', '--scheduler', address]) == 0
    killer.join()
    monkeypatch.setattr(conduct, 'workers_of', lambda *_: ThisProcess())
    assert campaign.main([str(spec), '--out', str(whole)]) == 0
    assert (out / RESULTS).read_bytes() == (whole / RESULTS).read_bytes()


def _kill_when(worker: Program, out: Path, count: int) -> None:
    """Kill a worker while shards are computed."""
    wait_for_shards(out, count)
    worker.send(signal.SIGKILL)
