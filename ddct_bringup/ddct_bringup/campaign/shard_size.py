# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Number of runs in a shard, which follows from the specification of a campaign."""

from ddct_bringup.batch.run_batch import MOST_RUNS as MOST_AT_ONCE
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.scored import are_linear

_MOST_RUNS = 2000
"""Largest number of runs in a shard."""
_LEAST_SHARDS = 50
"""Smallest number of shards of a large campaign, so that all workers end together."""
_MANY_LINEAR_RUNS = 1000
"""
Smallest number of linear runs of a campaign with fewer shards.

They are computed together, and each costs less the more they are.
"""
_LEAST_LINEAR_SHARDS = 4
"""Smallest number of shards of so many linear runs, which take seconds."""


def shard_size_of(campaign: Campaign) -> int:
    """Return the number of runs in a shard of a campaign."""
    runs = campaign.runs
    size = min(_MOST_RUNS, -(-runs // _LEAST_SHARDS))
    if size < MOST_AT_ONCE and runs >= _MANY_LINEAR_RUNS and are_linear(campaign):
        return max(size, min(MOST_AT_ONCE, -(-runs // _LEAST_LINEAR_SHARDS)))
    return size
