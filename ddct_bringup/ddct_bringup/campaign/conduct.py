# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Carry out a campaign: compute the missing shards, write each completely, and merge them."""

from collections.abc import Callable
from contextlib import closing
from pathlib import Path

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.columns import merge, parquet_bytes, schema_of
from ddct_bringup.campaign.plan import CampaignPlan, NoPlan, RecordedCampaign, carried
from ddct_bringup.campaign.shards import CampaignWork, runs_in, shards_of
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.manifest.begun import begun_manifest
from ddct_bringup.manifest.file_states import require_unaltered
from ddct_bringup.manifest.inputs import INPUTS, InputFiles
from ddct_bringup.manifest.limits import NamedLimits
from ddct_bringup.manifest.manifest import (
    CAMPAIGN,
    ITSELF,
    Manifest,
    begin_manifest,
    keep_digests,
    read_manifest,
    require_same_inputs,
    resume_manifest,
)
from ddct_bringup.manifest.written_before import WrittenBefore
from ddct_bringup.many_runs.engine import WorkEngine, Workers, workers_of
from ddct_bringup.run.output_folder import (
    locked_folders,
    mark_folder,
)
from ddct_bringup.verdict.limits import Limits
from ddct_plant.base.errors import DdctError
from ddct_plant.files.output_file import write_bytes
from ddct_plant.program.progress import Progress

RESULTS = 'results.parquet'
SHARDS = 'shards'
RESUME = 'what is done stays: go on with --resume'


def carry_out(
    campaign: Campaign,
    limits: Limits,
    out: Path,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    resume: bool = False,
    stopped: Callable[[], bool] = lambda: False,
) -> Path:
    """
    Carry out a campaign in the folder `out` and return its results file.

    Raise DdctError for unusable arguments and for a failure, KeyboardInterrupt when `stopped()`
    becomes true: completed shards stay, and `resume` continues with them.
    """
    with locked_folders(out), closing(workers_of(workers, scheduler)) as ready:
        recorded, manifest = _begin(
            campaign, limits, out, resume=resume, stopped=stopped, one_machine=scheduler is None
        )
        carry_out_recorded(recorded, manifest, limits, out, ready, stopped)
    return out / RESULTS


def carry_out_part(
    recorded: RecordedCampaign,
    limits: Limits,
    out: Path,
    *,
    workers: int | None = None,
    stopped: Callable[[], bool] = lambda: False,
) -> None:
    """
    Compute what is missing of a campaign that is a part of another result.

    Raise as `carry_out`.
    """
    with locked_folders(out), closing(workers_of(workers)) as ready:
        begin_folder(out)
        manifest = read_manifest(recorded.result)
        carry_out_recorded(recorded, manifest, limits, out, ready, stopped)


def carry_out_recorded(
    recorded: RecordedCampaign,
    manifest: Manifest,
    limits: Limits,
    out: Path,
    workers: Workers,
    stopped: Callable[[], bool],
) -> None:
    """Compute the missing shards of a campaign whose plan the manifest of its result has."""
    campaign = recorded.campaign()
    work = CampaignWork(campaign.spec, limits, recorded.origin.code, recorded.plan.spec_digest)
    names = shards_of(campaign, recorded.plan.shard_size)
    shards = {out / SHARDS / name: cases for name, cases in names.items()}
    written = WrittenBefore(recorded.result, manifest)
    missing = [file for file in shards if not written.has(file)]
    groups = len(campaign.controllers)
    done = campaign.runs - groups * sum(len(shards[file]) for file in missing)
    blocks = (runs_in(campaign, shards[file]) for file in missing)
    with Progress('runs', campaign.runs, done=done) as progress:
        for block in WorkEngine(work, workers, stopped, RESUME).done(blocks):
            file = missing[block.place]
            write_bytes(str(file), parquet_bytes(block.result, groups), RESUME)
            keep_digests([file])
            done += len(block.items)
            progress.update(done)
    require_unaltered(out, [file.relative_to(out).as_posix() for file in shards])
    rows = {file: groups * len(cases) for file, cases in shards.items()}
    merge(rows, groups, schema_of(campaign.spec), out / RESULTS, RESUME)
    keep_digests([out / RESULTS])


def _begin(
    campaign: Campaign,
    limits: Limits,
    out: Path,
    *,
    resume: bool,
    stopped: Callable[[], bool],
    one_machine: bool,
) -> tuple[RecordedCampaign, Manifest]:
    """Return campaign and manifest of the result; write it first unless it is resumed."""
    known = begun_manifest(out, 'campaign', SHARDS, resume=resume)
    inputs = InputFiles(campaign.spec.folder)
    content = carried(campaign.spec, inputs)
    named = NamedLimits.of(limits, inputs)
    if known:
        recorded = RecordedCampaign.read(out)
        require_unaltered(out, list(inputs.files))
        require_same_inputs(out, known, inputs)
        spec = spec_of(content, out / INPUTS)
        recorded.require_same(CampaignPlan.of(Campaign(spec), named, out))
        return recorded, resume_manifest(out, known, one_machine=one_machine)
    campaign.require_sound()
    require_going_on(stopped)
    begin_folder(out)
    inputs.copy(out)
    plan = CampaignPlan.of(Campaign(spec_of(content, out / INPUTS)), named, out)
    begin_manifest(out, CAMPAIGN, NoPlan(), inputs, {ITSELF: plan})
    manifest = resume_manifest(out, read_manifest(out), one_machine=one_machine)
    return RecordedCampaign.read(out), manifest


def begin_folder(out: Path) -> None:
    """Make the folder of a result, marked as ours, with that of its shards; raise DdctError."""
    mark_folder(out)
    try:
        (out / SHARDS).mkdir(exist_ok=True)
    except OSError as error:
        raise DdctError(f'cannot be written ({error.strerror})', place=out) from error


def require_going_on(stopped: Callable[[], bool]) -> None:
    """Raise KeyboardInterrupt where the user has stopped the campaign."""
    if stopped():
        raise KeyboardInterrupt(f'interrupted; {RESUME}')
