# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Shards, the unit of work: the runs of a fixed range of indices, whose rows become one file."""

import time
from dataclasses import dataclass

from ddct_bringup.campaign.columns import schema_of, shard_bytes
from ddct_bringup.campaign.manifest import require_code
from ddct_bringup.campaign.runs import Campaign
from ddct_bringup.campaign.scored import Scorer
from ddct_bringup.campaign.spec import CampaignSpec
from ddct_bringup.verdict.limits import Limits


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
    """One after the last index."""


def timed_shard(job: ShardJob) -> tuple[bytes, float]:
    """Return the file content of a shard, and its computing time in s."""
    started = time.monotonic()
    return compute_shard(job), time.monotonic() - started


def compute_shard(job: ShardJob) -> bytes:
    """Return the file content of a shard; raise DdctError where this machine cannot compute it."""
    require_code(job.code)
    campaign, scorer = _prepared(job)
    found = scorer.scored(campaign.planned(job.first, job.last))
    return shard_bytes(schema_of(job.spec), [each.row() for each in found])


_kept: dict[str, tuple[Campaign, Scorer]] = {}
"""Last campaign of this worker, by its digests: its shards share what does not vary."""


def _prepared(job: ShardJob) -> tuple[Campaign, Scorer]:
    """Return the campaign of a shard with its scorer; a worker builds them once."""
    key = f'{job.digest} {job.spec.folder} {job.limits.origin}'
    if key not in _kept:
        _kept.clear()
        _kept[key] = Campaign(job.spec), Scorer(job.limits)
    return _kept[key]
