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
from ddct_bringup.campaign.manifest import MANIFEST, Manifest
from ddct_bringup.campaign.shards import (
    ShardJob,
    TimeLeft,
    each_controller_first,
    timed_shard,
)
from ddct_bringup.digests.digest_file import Digests
from ddct_bringup.digests.files import altered_files, require_unaltered
from ddct_bringup.digests.writing import (
    begin_campaign_digests,
    finish_campaign_digests,
    keep_digests,
)
from ddct_bringup.run.output_folder import (
    MARKER,
    locked_folders,
    mark_folder,
    require_ours_or_empty,
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
        manifest = _begin(campaign, limits, out, resume=resume, stopped=stopped)
        digests = begin_campaign_digests(out, SHARDS, one_machine=scheduler is None)
        shards = _shards(campaign, limits, manifest, out)
        missing = {file: job for file, job in shards.items() if not _is_done(file, out, digests)}
        done = manifest.runs - sum(job.last - job.first for job in missing.values())
        progress = Progress('runs', manifest.runs, done=done)
        conduct = _Conduct(ready, progress, stopped, TimeLeft(campaign.cases))
        conduct.compute(missing, done)
        require_unaltered(out, [file.relative_to(out).as_posix() for file in shards])
        schema = schema_of(campaign.spec)
        rows = {file: job.last - job.first for file, job in shards.items()}
        merge(rows, schema, out / RESULTS, RESUME)
        finish_campaign_digests(out)
    return out / RESULTS


def _is_done(file: Path, out: Path, digests: Digests) -> bool:
    """
    Return whether a shard was written before; report one that was altered since.

    Its digest, kept when it was written, says that it has its rows: a campaign is resumed with the
    same manifest only.
    """
    name = file.relative_to(out).as_posix()
    if name not in digests.files or not file.exists():
        return False
    if altered_files(out, digests, [name]):
        complain(PROGRAM, f'{file}: altered since it was computed: it is computed again')
        return False
    return True


def _begin(
    campaign: Campaign, limits: Limits, out: Path, *, resume: bool, stopped: Callable[[], bool]
) -> Manifest:
    """Return the manifest in the folder; write it first unless the campaign is resumed."""
    manifest = Manifest.of(campaign, limits)
    require_ours_or_empty(out)
    if (out / MANIFEST).exists():
        known = Manifest.read(out)
        if not resume:
            raise DdctError(
                f'{out} holds a campaign: go on with --resume, or choose another --out',
                key='--resume',
            )
        known.require_same(manifest, out)
        require_unaltered(out, [MANIFEST])
        return known
    if resume:
        raise DdctError('there is nothing to go on with: leave --resume out', place=out)
    if out.is_dir() and {each.name for each in out.iterdir()} - {MARKER, SHARDS}:
        raise DdctError(f'{out} holds other results: choose another --out', key='--out')
    campaign.require_sound()
    require_going_on(stopped)
    mark_folder(out)
    (out / SHARDS).mkdir(exist_ok=True)
    manifest.write(out)
    return manifest


def _shards(
    campaign: Campaign, limits: Limits, manifest: Manifest, out: Path
) -> dict[Path, ShardJob]:
    """Return the jobs of the shards by file, in the order of the runs."""
    size, runs = manifest.shard_size, manifest.runs
    return {
        out / SHARDS / f'{first:08d}.parquet': ShardJob(
            campaign.spec,
            limits,
            manifest.code_digest,
            manifest.spec_digest,
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
        self.progress.end()

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
                write_bytes(str(file), rows, RESUME, ours=True)
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
