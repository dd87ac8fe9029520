# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Shards, the blocks of a campaign: the runs of all controllers in some cases, whose rows are a file.

So runs of one kind are together, and the controllers of a case share what is made of it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain, islice
from typing import NamedTuple

import pyarrow as pa

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.columns import runs_table, schema_of
from ddct_bringup.campaign.run_set import ImpossibleRow, PlannedRow
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
    key = f'{campaign.digest()} {campaign.spec.folder}'
    if key not in _together:  # finding it tries controllers
        _together[key] = are_together(campaign)
    size = block_size(campaign.runs, together=_together[key])
    return max(1, size // len(campaign.controllers))


_together: dict[str, bool] = {}
"""Whether runs are computed together, by digest and folder of the campaign."""


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
class CampaignPart:
    """A campaign of some work: all that a worker needs, besides the files it names."""

    spec: CampaignSpec
    digest: str
    """Digest of the specification and of the files that it names."""

    def require_unchanged(self) -> None:
        """Raise DdctError where a file of the specification has changed since the beginning."""
        if digest_of(self.spec) != self.digest:
            raise DdctError(
                'a file that the specification names has changed since the campaign began: put '
                'the old one back'
            )


class CampaignRun(NamedTuple):
    """A run of one of the campaigns of some work."""

    campaign: int
    """Place of its campaign."""
    run: int
    """Index of the run in it."""


@dataclass(frozen=True)
class CampaignWork(Work[CampaignRun, list[pa.Table]]):
    """
    Runs of one or more campaigns, and their rows: one table for each campaign.

    The items of a block are in the order of campaigns and of indices.
    """

    campaigns: Sequence[CampaignPart]
    limits: Limits
    code: str
    """Digest of the sources that compute the campaigns."""

    def of_block(self, items: Sequence[CampaignRun]) -> list[pa.Table]:
        """Return the rows of some runs; raise DdctError where this machine cannot compute them."""
        require_code(self.code)
        runs = self._runs(items)
        found = iter(Scorer(self.limits).scored(chain.from_iterable(runs)))
        rows = [
            runs_table(schema_of(part.spec), [*islice(found, len(its))])
            for part, its in zip(self.campaigns, runs, strict=True)
        ]
        self._require_unchanged()  # each run has read its handover file anew
        return rows

    def joined(self, parts: Sequence[list[pa.Table]]) -> list[pa.Table]:
        """Return the rows of all parts."""
        return [pa.concat_tables(each).combine_chunks() for each in zip(*parts, strict=True)]

    def without_result(self, item: CampaignRun, why: str) -> list[pa.Table]:
        """Return the row of a run that ends its process."""
        scorer = Scorer(self.limits)
        return [
            runs_table(schema_of(part.spec), [scorer.without_result(run, why) for run in its])
            for part, its in zip(self.campaigns, self._runs([item]), strict=True)
        ]

    def error(self, items: Sequence[CampaignRun], error: Exception) -> Exception:
        """Return a DdctError that names the first run of the block."""
        what = str(error) if isinstance(error, DdctError) else f'{type(error).__name__}: {error}'
        return DdctError(
            f'run {items[0].run} or one of its shard could not be computed ({what}); what is '
            'done stays: go on with --resume'
        )

    def _runs(self, items: Sequence[CampaignRun]) -> list[list[PlannedRow | ImpossibleRow]]:
        """Return the runs of some items, campaign by campaign."""
        return [
            [*campaign.planned_at([each.run for each in items if each.campaign == place])]
            for place, campaign in enumerate(self._prepared())
        ]

    def _prepared(self) -> list[Campaign]:
        """Return the campaigns; a worker builds them once."""
        keys = [f'{part.digest} {part.spec.folder}' for part in self.campaigns]
        if {*keys} != {*_kept}:
            self._require_unchanged()
            _kept.clear()
            for key, part in zip(keys, self.campaigns, strict=True):
                _kept[key] = Campaign(part.spec)
        return [_kept[key] for key in keys]

    def _require_unchanged(self) -> None:
        for part in self.campaigns:
            part.require_unchanged()


_kept: dict[str, Campaign] = {}
"""Last campaigns of this process, by their digests: their shards share what does not vary."""
