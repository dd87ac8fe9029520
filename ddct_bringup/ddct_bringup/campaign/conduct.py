# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Carry out a campaign: compute the missing shards, write each completely, and merge them."""

from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Future, wait
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.columns import merge, schema_of
from ddct_bringup.campaign.executors import Workers, workers_of
from ddct_bringup.campaign.plan import CampaignPlan, RecordedCampaign, carried
from ddct_bringup.campaign.shards import (
    ShardJob,
    TimeLeft,
    each_controller_first,
    timed_shard,
)
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.manifest.begun import begun_manifest
from ddct_bringup.manifest.file_states import altered_files, require_unaltered
from ddct_bringup.manifest.inputs import INPUTS, InputFiles, full_path
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
from ddct_bringup.run.output_folder import (
    locked_folders,
    mark_folder,
)
from ddct_bringup.verdict.limits import Limits
from ddct_plant.base.errors import DdctError
from ddct_plant.files.output_file import write_bytes
from ddct_plant.program.command_line import complain
from ddct_plant.program.progress import Progress

RESULTS = 'results.parquet'
SHARDS = 'shards'
PROGRAM = 'ddct campaign'
RESUME = 'what is done stays: go on with --resume'
_AHEAD = 2
"""Number of shards queued per worker, so that none waits for the next."""
_MOST_DEATHS = 3
"""Largest number of failed workers in succession without a completed shard."""
_POLL_S = 0.2
"""Time in s between two checks of signals and workers."""


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
    with locked_folders(out), workers_of(workers, scheduler) as ready:
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
    with locked_folders(out), workers_of(workers, None) as ready:
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
    shards = _shards(campaign, limits, recorded, out)
    done_before = _Done(recorded.result, manifest)
    missing = {file: job for file, job in shards.items() if not done_before.has(file)}
    runs = campaign.runs
    done = runs - sum(job.last - job.first for job in missing.values())
    with Progress('runs', runs, done=done) as progress:
        _Conduct(workers, progress, stopped, TimeLeft(campaign.cases)).compute(missing, done)
    require_unaltered(out, [file.relative_to(out).as_posix() for file in shards])
    schema = schema_of(campaign.spec)
    rows = {file: job.last - job.first for file, job in shards.items()}
    merge(rows, schema, out / RESULTS, RESUME)
    keep_digests([out / RESULTS])


@dataclass(frozen=True)
class _Done:
    """
    Shards that were written before.

    Their digests, kept when they were written, say that they have their rows: a campaign is
    resumed with the same plan only.
    """

    result: Path
    manifest: Manifest

    def has(self, file: Path) -> bool:
        """Return whether a shard was written before; report one that was altered since."""
        name = full_path(file).relative_to(full_path(self.result)).as_posix()
        if name not in self.manifest.files or not file.exists():
            return False
        if altered_files(self.result, self.manifest, [name]):
            complain(PROGRAM, f'{file}: altered since it was computed: it is computed again')
            return False
        return True


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
    begin_manifest(out, CAMPAIGN, {}, inputs, {ITSELF: plan})
    manifest = resume_manifest(out, read_manifest(out), one_machine=one_machine)
    return RecordedCampaign.read(out), manifest


def begin_folder(out: Path) -> None:
    """Make the folder of a result, marked as ours, with that of its shards; raise DdctError."""
    mark_folder(out)
    try:
        (out / SHARDS).mkdir(exist_ok=True)
    except OSError as error:
        raise DdctError(f'cannot be written ({error.strerror})', place=out) from error


def _shards(
    campaign: Campaign, limits: Limits, recorded: RecordedCampaign, out: Path
) -> dict[Path, ShardJob]:
    """Return the jobs of the shards by file, in the order of the runs."""
    size, runs = recorded.plan.shard_size, campaign.runs
    return {
        out / SHARDS / f'{first:08d}.parquet': ShardJob(
            campaign.spec,
            limits,
            recorded.origin.code,
            recorded.plan.spec_digest,
            first,
            min(first + size, runs),
        )
        for first in range(0, runs, size)
    }


@dataclass
class _Conduct:
    """Executes shard jobs on the workers until every shard is on the disk."""

    workers: Workers
    progress: Progress
    stopped: Callable[[], bool]
    time_left: TimeLeft

    def compute(self, shards: Mapping[Path, ShardJob], done: int) -> None:
        """Compute shards and write each to its file; `done` runs were computed before."""
        missing = dict(shards)
        deaths = 0
        while missing:
            try:
                for file in self._written(missing):
                    job = missing.pop(file)
                    done += job.last - job.first
                    deaths = 0
                    left_s = self.time_left.left_s(missing.values(), self.workers.count)
                    self.progress.update(done, left_s)
            except (BrokenExecutor, CancelledError) as error:
                self.workers.require_alive()
                deaths += 1
                if deaths == _MOST_DEATHS:
                    raise DdctError(
                        f'workers died {deaths} times one after the other: free some memory or '
                        f'take fewer of them; {RESUME}'
                    ) from error

    def _written(self, shards: Mapping[Path, ShardJob]) -> Iterator[Path]:
        """Yield the file of each shard after it is written; raise an error of the executor."""
        executor = self.workers.executor()
        waiting = iter(each_controller_first(shards, self.time_left.cases))
        running: dict[Future[tuple[bytes, float]], Path] = {}
        while True:
            free = _AHEAD * self.workers.count - len(running)
            for file in islice(waiting, max(free, 0)):
                running[executor.submit(timed_shard, shards[file])] = file
            if not running:
                return
            finished = wait(running, _POLL_S, FIRST_COMPLETED).done
            require_going_on(self.stopped)
            if not finished:
                self.workers.require_alive()
            for future in finished:
                file = running.pop(future)
                rows, seconds = _result(future, shards[file])
                write_bytes(str(file), rows, RESUME)
                keep_digests([file])
                self.time_left.add(shards[file], seconds)
                yield file


def require_going_on(stopped: Callable[[], bool]) -> None:
    """Raise KeyboardInterrupt where the user has stopped the campaign."""
    if stopped():
        raise KeyboardInterrupt(f'interrupted; {RESUME}')


def _result(future: Future[tuple[bytes, float]], job: ShardJob) -> tuple[bytes, float]:
    try:
        return future.result()
    except (BrokenExecutor, CancelledError):
        raise
    except Exception as error:
        what = str(error) if isinstance(error, DdctError) else f'{type(error).__name__}: {error}'
        raise DdctError(
            f'runs {job.first} to {job.last - 1} could not be computed ({what}); {RESUME}'
        ) from error
