# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Shards, the blocks of a campaign: the runs of all controllers in some cases, whose rows are a file.

So runs of one kind are together, and the controllers of a case share what is made of it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import pyarrow as pa

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.columns import runs_table, schema_of
from ddct_bringup.campaign.scored import Scorer, are_together
from ddct_bringup.campaign.spec import CampaignSpec
from ddct_bringup.campaign.specification.named_files import digest_of
from ddct_bringup.manifest.code import code_digest
from ddct_bringup.many_runs.blocks import block_size
from ddct_bringup.many_runs.work import Work
from ddct_bringup.verdict.limits import Limits
from ddct_plant.base.errors import DdctError


def shard_size_of(campaign: Campaign) -> int:
    """Return the number of cases in a shard, which follows from the specification alone."""
    size = block_size(campaign.runs, together=are_together(campaign))
    return max(1, size // len(campaign.controllers))


def shards_of(campaign: Campaign, size: int) -> dict[str, range]:
    """Return the cases of each shard by the name of its file."""
    cases = range(campaign.cases)
    return {
        f'{first:08d}.parquet': cases[first : first + size]
        for first in range(0, campaign.cases, size)
    }


def runs_in(campaign: Campaign, cases: range) -> list[int]:
    """Return the indices of the runs in some cases: all of one controller, then of the next."""
    first_runs = range(0, campaign.runs, campaign.cases)
    return [first + case for first in first_runs for case in cases]


def require_code(digest: str) -> None:
    """Raise DdctError unless this process has the sources of the campaign's start."""
    if code_digest() != digest:
        raise DdctError(
            'a worker has other sources than the program that started the campaign: install the '
            'same version there'
        )


@dataclass(frozen=True)
class CampaignWork(Work[int, pa.Table]):
    """
    Runs of a campaign by their indices, and their rows.

    A worker needs nothing else, besides the files that the specification names.
    """

    spec: CampaignSpec
    limits: Limits
    code: str
    """Digest of the sources that compute the campaign."""
    digest: str
    """Digest of the specification and of the files that it names."""

    def of_block(self, items: Sequence[int]) -> pa.Table:
        """Return the rows of some runs; raise DdctError where this machine cannot compute them."""
        require_code(self.code)
        campaign, scorer = self._prepared()
        found = scorer.scored(campaign.planned_at(items))
        rows = runs_table(schema_of(self.spec), found)
        self._require_unchanged()  # each run has read its handover file anew
        return rows

    def joined(self, parts: Sequence[pa.Table]) -> pa.Table:
        """Return the rows of all parts."""
        return pa.concat_tables(parts).combine_chunks()

    def without_result(self, item: int, why: str) -> pa.Table:
        """Return the row of a run that ends its process."""
        campaign, scorer = self._prepared()
        (run,) = campaign.planned_at([item])
        return runs_table(schema_of(self.spec), [scorer.without_result(run, why)])

    def error(self, items: Sequence[int], error: Exception) -> Exception:
        """Return a DdctError that names the first run of the shard."""
        what = str(error) if isinstance(error, DdctError) else f'{type(error).__name__}: {error}'
        return DdctError(
            f'run {items[0]} or one of its shard could not be computed ({what}); what is done '
            'stays: go on with --resume'
        )

    def _prepared(self) -> tuple[Campaign, Scorer]:
        """Return the campaign and its scorer; a worker builds them once."""
        key = f'{self.digest} {self.spec.folder} {self.limits.origin}'
        if key not in _kept:
            self._require_unchanged()
            _kept.clear()
            _kept[key] = Campaign(self.spec), Scorer(self.limits)
        return _kept[key]

    def _require_unchanged(self) -> None:
        """Raise DdctError where a file of the specification has changed since the beginning."""
        if digest_of(self.spec) != self.digest:
            raise DdctError(
                'a file that the specification names has changed since the campaign began: put '
                'the old one back'
            )


_kept: dict[str, tuple[Campaign, Scorer]] = {}
"""Last campaign of this process, by its digests: its shards share what does not vary."""
