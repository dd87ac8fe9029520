# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The runs of a shard that are computed at once equal those computed step by step."""

from pathlib import Path
from typing import Any

import pytest

from ddct_bringup.campaign import scored, shards
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.columns import differences, parquet_bytes, runs_table, schema_of
from ddct_bringup.campaign.rows import VECTORISED
from ddct_bringup.campaign.scored import Scorer
from ddct_bringup.campaign.shards import (
    CampaignPart,
    CampaignRun,
    CampaignWork,
    runs_in,
    shard_size_of,
    shards_of,
)
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.manifest.code import code_digest
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.registry import make_controller

GAIN = 'controllers.pi.proportional_gain'


def rows_of(**content: Any) -> list[dict[str, Any]]:
    """Return the rows of all runs of a specification, computed as one shard."""
    campaign = Campaign(spec_of(content, Path()))
    found = Scorer(packaged_limits()).scored(campaign.planned(0, campaign.runs))
    return runs_table(schema_of(campaign.spec), found).to_pylist()


def test_each_run_has_a_controller_of_its_own_gains(monkeypatch) -> None:
    content = {'controllers': ['pi'], 'grid': {GAIN: [0.05, 0.1, 0.2], 'wear_gain': [0.8, 1.0]}}
    rows = rows_of(**content)
    assert {row['path'] for row in rows} == {VECTORISED}
    monkeypatch.setattr(scored, 'why_not_batchable', lambda settings, controller: 'not now')
    alone = rows_of(**content)
    for row, expected in zip(rows, alone, strict=True):
        assert differences(row, {**expected, 'path': VECTORISED}) == []
    assert len({row['torsion_speed_std_rpm'] for row in rows}) == len(rows)


def test_each_run_is_scored_over_the_window_that_its_scenario_gives(monkeypatch) -> None:
    grid = {'duration_s': [1.2], 'score_window_s': [[0.6, 0.9], [0.6, 1.1], [0.8, 1.1]]}
    content = {'controllers': ['ls8'], 'grid': grid}
    rows = rows_of(**content)
    assert {row['path'] for row in rows} == {VECTORISED}
    monkeypatch.setattr(scored, 'why_not_batchable', lambda settings, controller: 'not now')
    alone = rows_of(**content)
    for row, expected in zip(rows, alone, strict=True):
        assert differences(row, expected) == []


def test_runs_with_equal_known_settings_share_a_controller(monkeypatch) -> None:
    made = []

    def counted(chosen, known):
        made.append(chosen.name)
        return make_controller(chosen, known)

    monkeypatch.setattr(scored, 'make_controller', counted)
    wear = {'wear_gain': [0.8, 0.9, 1.0], 'duration_s': [1.2]}
    rows = rows_of(controllers=['ls8', 'mpc3'], grid=wear)
    assert {row['path'] for row in rows} == {VECTORISED}
    assert sorted(made) == ['ls8', 'mpc3']


@pytest.mark.parametrize(('why_not', 'cases'), [('', 500), ('not now', 40)])
def test_shards_of_runs_that_are_computed_together_are_large(
    why_not: str, cases: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scored, 'why_not_batchable', lambda settings, controller: why_not)
    monkeypatch.setattr(shards, '_together', {})
    wear = {'wear_gain': {'distribution': 'uniform', 'low': 0.8, 'high': 1.2}}
    random = {'samples': 2000, 'vary': wear}
    content = {'controllers': ['pi', 'ls8'], 'random': random}
    campaign = Campaign(spec_of(content, Path()))
    assert shard_size_of(campaign) == cases
    found = shards_of(campaign, cases)
    assert [*found][:2] == ['00000000.parquet', f'{cases:08d}.parquet']
    runs = sorted(index for each in found.values() for index in runs_in(campaign, each))
    assert runs == list(range(campaign.runs))


def test_a_shard_has_the_runs_of_all_controllers_in_its_cases() -> None:
    content = {'controllers': ['pi', 'ls8', 'mpc3'], 'grid': {'wear_gain': [0.8, 1.0, 1.2]}}
    campaign = Campaign(spec_of(content, Path()))
    assert runs_in(campaign, range(1, 3)) == [1, 2, 4, 5, 7, 8]
    planned = [*campaign.planned_at([1, 2, 4, 5, 7, 8])]
    assert planned == [campaign.run(index) for index in (1, 2, 4, 5, 7, 8)]


def work_of(*contents: dict[str, Any]) -> CampaignWork:
    """Return the work of the campaigns of some specifications."""
    campaigns = [Campaign(spec_of(content, Path())) for content in contents]
    parts = [CampaignPart(each.spec, each.digest()) for each in campaigns]
    return CampaignWork(parts, packaged_limits(), code_digest())


def test_a_row_of_a_run_that_ends_its_process_has_the_reason() -> None:
    work = work_of({'controllers': ['pi'], 'grid': {'wear_gain': [0.8, 1]}})
    runs = [CampaignRun(0, 0), CampaignRun(0, 1)]
    (whole,) = work.of_block(runs)
    reason = 'its process crashed (SIGSEGV)'
    parts = [work.of_block(runs[:1]), work.without_result(runs[1], reason)]
    (joined,) = work.joined(parts)
    first, second = joined.to_pylist()
    assert first == whole.to_pylist()[0]
    same = ('index', 'controller', 'wear_gain', 'seed')
    assert [second[name] for name in same] == [whole.to_pylist()[1][name] for name in same]
    assert (second['valid'], second['state']) == (False, 'invalid')
    assert second['reason'] == reason
    (again,) = work.joined([work.of_block(runs[:1]), work.of_block(runs[1:])])
    assert parquet_bytes(again) == parquet_bytes(whole)


def test_rows_of_campaigns_that_are_computed_together_are_those_of_each_alone() -> None:
    first = {'controllers': ['pi'], 'grid': {'wear_gain': [0.8, 1.0]}}
    second = {'controllers': ['ls8', 'pi'], 'grid': {'clutch': ['linear']}}
    alone = [
        work_of(each).of_block([CampaignRun(0, 0), CampaignRun(0, 1)])[0]
        for each in (first, second)
    ]
    work = work_of(first, second)
    runs = [CampaignRun(campaign, index) for campaign in (0, 1) for index in (0, 1)]
    together = work.of_block(runs)
    assert list(map(parquet_bytes, together)) == list(map(parquet_bytes, alone))
    parts = [work.of_block(runs[:1]), work.of_block(runs[1:3]), work.of_block(runs[3:])]
    assert list(map(parquet_bytes, work.joined(parts))) == list(map(parquet_bytes, alone))
