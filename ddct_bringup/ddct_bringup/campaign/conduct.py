# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Carry out a campaign: compute the missing shards, write each completely, and merge them."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Self

import pyarrow as pa

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.columns import merge, parquet_bytes, schema_of
from ddct_bringup.campaign.plan import CampaignPlan, NoPlan, RecordedCampaign, carried
from ddct_bringup.campaign.shards import (
    CampaignPart,
    CampaignRun,
    CampaignWork,
    runs_in,
    shards_of,
)
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
        _compute([MissingShards.of(recorded, manifest, out)], limits, ready, stopped)
    return out / RESULTS


def carry_out_parts(
    parts: Mapping[Path, RecordedCampaign],
    limits: Limits,
    *,
    workers: int | None = None,
    stopped: Callable[[], bool] = lambda: False,
) -> None:
    """
    Compute what is missing of campaigns that are parts of another result, by their folders.

    Shards of equal place are computed together. Raise as `carry_out`.
    """
    with locked_folders(*parts), closing(workers_of(workers)) as ready:
        missing = []
        for out, recorded in parts.items():
            begin_folder(out)
            missing.append(MissingShards.of(recorded, read_manifest(recorded.result), out))
        _compute(missing, limits, ready, stopped)


@dataclass(frozen=True)
class MissingShards:
    """A campaign whose plan the manifest of its result has, and its shards."""

    recorded: RecordedCampaign
    campaign: Campaign
    out: Path
    shards: Mapping[Path, range]
    """Cases of all shards by their files."""
    missing: Sequence[Path]
    """Files of the shards that are to be computed."""

    @classmethod
    def of(cls, recorded: RecordedCampaign, manifest: Manifest, out: Path) -> Self:
        """Return the shards of a campaign in a folder, which are there or missing."""
        campaign = recorded.campaign()
        names = shards_of(campaign, recorded.plan.shard_size)
        shards = {out / SHARDS / name: cases for name, cases in names.items()}
        written = WrittenBefore(recorded.result, manifest)
        return cls(
            recorded, campaign, out, shards, [file for file in shards if not written.has(file)]
        )

    @property
    def controllers(self) -> int:
        """Number of controllers, which is that of the runs in a case."""
        return len(self.campaign.controllers)

    @property
    def done(self) -> int:
        """Number of runs that are there."""
        cases = sum(len(self.shards[file]) for file in self.missing)
        return self.campaign.runs - self.controllers * cases

    def runs(self, place: int, shard: int) -> list[CampaignRun]:
        """Return the runs of a missing shard, none after the last; `place` is the campaign's."""
        if shard >= len(self.missing):
            return []
        indices = runs_in(self.campaign, self.shards[self.missing[shard]])
        return [CampaignRun(place, index) for index in indices]

    def write(self, shard: int, rows: pa.Table) -> None:
        """Write a missing shard."""
        file = self.missing[shard]
        write_bytes(str(file), parquet_bytes(rows, self.controllers), RESUME)
        keep_digests([file])

    def merge(self) -> None:
        """Write the results of all shards."""
        require_unaltered(
            self.out, [file.relative_to(self.out).as_posix() for file in self.shards]
        )
        rows = {file: self.controllers * len(cases) for file, cases in self.shards.items()}
        schema = schema_of(self.campaign.spec)
        merge(rows, self.controllers, schema, self.out / RESULTS, RESUME)
        keep_digests([self.out / RESULTS])


def _compute(
    parts: Sequence[MissingShards],
    limits: Limits,
    workers: Workers,
    stopped: Callable[[], bool],
) -> None:
    """Compute the missing shards of campaigns of one result, and merge them."""
    work = CampaignWork(
        [CampaignPart(part.campaign.spec, part.recorded.plan.spec_digest) for part in parts],
        limits,
        parts[0].recorded.origin.code,
    )
    blocks = (
        [run for place, part in enumerate(parts) for run in part.runs(place, shard)]
        for shard in range(max(len(part.missing) for part in parts))
    )
    runs, done = sum(part.campaign.runs for part in parts), sum(part.done for part in parts)
    with Progress('runs', runs, done=done) as progress:
        for block in WorkEngine(work, workers, stopped, RESUME).done(blocks):
            for part, rows in zip(parts, block.result, strict=True):
                if len(rows):
                    part.write(block.place, rows)
            done += len(block.items)
            progress.update(done)
    for part in parts:
        part.merge()


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
