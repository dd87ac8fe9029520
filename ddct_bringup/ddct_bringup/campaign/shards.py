# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Shards, the unit of work: the runs of a fixed range of indices, whose rows become one file.

Their order, and the time left by those that are done.
"""

import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.columns import schema_of, shard_bytes
from ddct_bringup.campaign.plan import require_code
from ddct_bringup.campaign.scored import Scorer
from ddct_bringup.campaign.spec import CampaignSpec
from ddct_bringup.campaign.specification.named_files import digest_of
from ddct_bringup.verdict.limits import Limits
from ddct_plant.base.errors import DdctError


@dataclass(frozen=True)
class ShardJob:
    """Input of a worker; the only other inputs are the files that the specification names."""

    spec: CampaignSpec
    limits: Limits
    code: str
    """Digest of the sources that compute the campaign."""
    digest: str
    """Digest of the specification and of the files that it names."""
    first: int
    last: int
    """Last index plus one."""


def timed_shard(job: ShardJob) -> tuple[bytes, float]:
    """Return the file content of a shard, and its computing time in s."""
    started = time.perf_counter()
    return compute_shard(job), time.perf_counter() - started


def compute_shard(job: ShardJob) -> bytes:
    """Return the file content of a shard; raise DdctError where this machine cannot compute it."""
    require_code(job.code)
    campaign, scorer = _prepared(job)
    found = scorer.scored(campaign.planned(job.first, job.last))
    rows = shard_bytes(schema_of(job.spec), [each.row() for each in found])
    _require_unchanged(job)  # each run has read its handover file anew
    return rows


def _require_unchanged(job: ShardJob) -> None:
    """Raise DdctError where a file of the specification has changed since the campaign began."""
    if digest_of(job.spec) != job.digest:
        raise DdctError(
            'a file that the specification names has changed since the campaign began: put the '
            'old one back'
        )


_kept: dict[str, tuple[Campaign, Scorer]] = {}
"""Last campaign of this worker, by its digests: its shards share what does not vary."""


def _prepared(job: ShardJob) -> tuple[Campaign, Scorer]:
    """Return the campaign of a shard with its scorer; a worker builds them once."""
    key = f'{job.digest} {job.spec.folder} {job.limits.origin}'
    if key not in _kept:
        _require_unchanged(job)
        _kept.clear()
        _kept[key] = Campaign(job.spec), Scorer(job.limits)
    return _kept[key]


@dataclass
class TimeLeft:
    """Estimates the remaining time from completed shards."""

    cases: int
    """Number of runs of each controller, in the order of the controllers."""
    _runs: dict[int, int] = field(default_factory=dict)
    _seconds: dict[int, float] = field(default_factory=dict)

    def add(self, job: ShardJob, seconds: float) -> None:
        """Count a completed shard with its computing time in s."""
        for controller, runs in self._parts(job):
            share = seconds * runs / (job.last - job.first)
            self._runs[controller] = self._runs.get(controller, 0) + runs
            self._seconds[controller] = self._seconds.get(controller, 0.0) + share

    def left_s(self, missing: Iterable[ShardJob], workers: int) -> float | None:
        """
        Return the time in s for the missing shards with this many workers, None before the first.

        A controller without a completed shard counts as the mean of the others.
        """
        if not self._runs:
            return None
        rates = {each: self._seconds[each] / self._runs[each] for each in self._runs}
        mean = sum(rates.values()) / len(rates)
        parts = [part for job in missing for part in self._parts(job)]
        return sum(runs * rates.get(controller, mean) for controller, runs in parts) / workers

    def _parts(self, job: ShardJob) -> Iterable[tuple[int, int]]:
        """Yield the index of each controller in a shard with the number of its runs there."""
        for controller in range(job.first // self.cases, (job.last - 1) // self.cases + 1):
            first = max(job.first, controller * self.cases)
            yield controller, min(job.last, (controller + 1) * self.cases) - first


def each_controller_first(shards: Mapping[Path, ShardJob], cases: int) -> Sequence[Path]:
    """
    Return the files of shards in the order of their computation.

    The first shard of each controller comes before all others, so that each is soon measured.
    """
    first: dict[int, Path] = {}
    for file, job in shards.items():
        first.setdefault(job.first // cases, file)
    chosen = set(first.values())
    return [*first.values(), *(file for file in shards if file not in chosen)]
