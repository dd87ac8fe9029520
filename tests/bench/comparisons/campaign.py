# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Cost of campaigns beside the computation of their runs alone.

The cost of a run is the difference of a long and a short campaign, so that starting the program
does not count.
"""

import tempfile
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path

from bench.comparisons.headless import step_s
from bench.peers.dask_cluster import cluster
from bench.peers.numpy_loop import STEPS
from bench.skeleton.comparison import Bench, Sides, comparison, extra
from bench.skeleton.workspace import Cost, Workspace
from pyarrow import parquet

from ddct_bringup.batch.run_batch import run_batch
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.spec import read_spec
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.registry import make_controller
from ddct_plant.models.clutch import STICK_SLIP

_SPEC = """\
controllers: [{controller}]
clutch: {clutch}
random:
  samples: {runs}
  vary:
    wear_gain: {{distribution: uniform, low: 0.8, high: 1.2}}
"""
_FEW = 8


def write_spec(folder: Path, controller: str, clutch: str, runs: int) -> Path:
    """Write the specification of runs with random wear into a folder, and return its file."""
    spec = folder / 'campaign.yaml'
    text = _SPEC.format(controller=controller, clutch=clutch, runs=runs)
    spec.write_text(text, encoding='utf-8')
    return spec


def campaign(workspace: Workspace, controller: str, clutch: str, runs: int, *options: str) -> Cost:
    """Carry out a campaign by its program; return what it took."""
    with tempfile.TemporaryDirectory() as folder:
        spec, out = write_spec(Path(folder), controller, clutch, runs), Path(folder) / 'out'
        cost = workspace.run('ddct', 'campaign', spec, '--out', out, *options)
        assert parquet.read_metadata(out / 'results.parquet').num_rows == runs
    return cost


def run_s(workspace: Workspace, controller: str, clutch: str, runs: int) -> float:
    """Return the processor time in s that a run adds to a campaign of one process."""
    one = partial(campaign, workspace, controller, clutch)
    few, many = (one(count, '--workers', '1').processor_s for count in (_FEW, _FEW + runs))
    return (many - few) / runs


@comparison('campaign of linear runs, run', 'its computation alone', at_most=1.5)
def linear_campaign(bench: Bench) -> Iterator[Sides]:
    """Processor time per run of PI, 4000 runs, all-in beside simulation, metrics and verdict."""
    count, limits = 4000, packaged_limits()
    with tempfile.TemporaryDirectory() as folder:
        planned = Campaign(read_spec(write_spec(Path(folder), 'pi', 'linear', count)))
        settings = [planned.run(index).settings for index in range(count)]
    controller = make_controller('pi', settings[0])

    def computation() -> float:
        started = time.process_time()
        run_batch([(each, controller) for each in settings], limits)
        return (time.process_time() - started) / count

    yield Sides(lambda: run_s(bench.ours, 'pi', 'linear', count), computation, warm_up=False)


@comparison('campaign of mpc3 with sticking plates, run', 'its headless steps alone')
def predictive_campaign(bench: Bench) -> Iterator[Sides]:
    """Processor time per run, 100 runs, all-in beside the steps of headless runs."""

    def steps() -> float:
        return STEPS * step_s('mpc3', clutch=STICK_SLIP)

    steps()
    yield Sides(lambda: run_s(bench.ours, 'mpc3', STICK_SLIP, 100), steps, warm_up=False)


@comparison('campaign on two Dask workers', 'one Dask worker', at_most=1 / 1.6)
def two_dask_workers(bench: Bench) -> Iterator[Sides]:
    """Wall time that 200 runs of mpc3 add to a campaign; each worker has one thread."""
    extra('distributed')

    def wall_s(workers: int) -> float:
        with cluster(workers) as address:
            one = partial(campaign, bench.ours, 'mpc3', STICK_SLIP)
            options = ('--scheduler', address)
            one(_FEW, *options)  # the workers import
            few, many = (one(count, *options).wall_s for count in (_FEW, _FEW + 200))
            return many - few

    yield Sides(lambda: wall_s(2), lambda: wall_s(1), warm_up=False)
