# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Shards, the unit of work: the runs of a fixed range of indices, whose rows become one file."""

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ddct_bringup.batch.batchable import batchable
from ddct_bringup.batch.run_batch import run_batch
from ddct_bringup.campaign.columns import INDEX, SEED, schema_of, shard_bytes
from ddct_bringup.campaign.manifest import require_code
from ddct_bringup.campaign.rows import SERIAL, VECTORISED, result_row, scored_headless
from ddct_bringup.campaign.runs import Campaign, CampaignRun
from ddct_bringup.campaign.spec import CampaignSpec
from ddct_bringup.run.description import facts_of
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.limits import Limits
from ddct_controllers.interface import THESIS, Controller
from ddct_controllers.registry import make_controller, own_controller_names
from ddct_plant.base.errors import FOREIGN_FAILURES


@dataclass(frozen=True)
class ShardJob:
    """Input of a worker; the only other inputs are the files that the specification names."""

    spec: CampaignSpec
    limits: Limits
    code: str
    """Digest of the sources that compute the campaign."""
    first: int
    last: int
    """One after the last index."""


def timed_shard(job: ShardJob) -> tuple[bytes, float]:
    """Return the file content of a shard, and its computing time in s."""
    started = time.monotonic()
    return compute_shard(job), time.monotonic() - started


def compute_shard(job: ShardJob) -> bytes:
    """Return the file content of a shard; raise DdctError where this machine cannot compute it."""
    require_code(job.code)
    campaign = Campaign(job.spec)
    runs = [campaign.run(index) for index in range(job.first, job.last)]
    with np.errstate(all='ignore'):  # a value that is not finite becomes a reason in its row
        return shard_bytes(schema_of(job.spec), compute_rows(runs, job.limits))


def compute_rows(runs: Sequence[CampaignRun], limits: Limits) -> list[dict[str, Any]]:
    """
    Return a row for every run, in their order; a failed run has a row with its reason.

    Linear runs are computed at once, all others step by step.
    """
    found = _vectorised(runs, limits)
    rows = []
    for run in runs:
        scored, path = found.get(run.index), VECTORISED
        if scored is None:
            scored, path = scored_headless(run.settings, run.controller, limits), SERIAL
        ours = {INDEX: run.index, SEED: run.settings.seed}
        rows.append({**ours, **result_row(scored, run.varied, path)})
    return rows


def _vectorised(runs: Sequence[CampaignRun], limits: Limits) -> dict[int, ScoredRun]:
    """Return the scores of the runs that can be computed at once, by index."""
    suited = []
    shared: dict[str, Controller] = {}
    for run in runs:
        try:
            controller = _controller(run, shared)
        except FOREIGN_FAILURES:
            continue  # the run step by step gives the reason
        if not batchable(run.settings, controller):
            suited.append((run, controller))
    results = run_batch([(run.settings, controller) for run, controller in suited], limits)
    return {
        run.index: _with_facts(result, run)
        for (run, _), result in zip(suited, results, strict=True)
        if result is not None
    }


def _with_facts(scored: ScoredRun, run: CampaignRun) -> ScoredRun:
    name = run.controller.name
    return replace(
        scored, bag=name, facts=facts_of(run.settings, name, run.settings.scenario.steps)
    )


def _controller(run: CampaignRun, shared: dict[str, Controller]) -> Controller:
    """Return the controller of a run; a packaged one that no run changes is built once."""
    spec = run.controller
    if spec.computed_from != THESIS or spec.name not in own_controller_names():
        return make_controller(spec, run.settings)
    key = repr((spec.name, run.settings.scenario.controllers.get(spec.name)))
    if key not in shared:
        shared[key] = make_controller(spec, run.settings)
    return shared[key]
