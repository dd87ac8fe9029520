# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The runs of a shard that are computed at once equal those computed step by step."""

from pathlib import Path
from typing import Any

import pytest

from ddct_bringup.campaign import scored
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.columns import differences
from ddct_bringup.campaign.rows import VECTORISED
from ddct_bringup.campaign.scored import Scorer
from ddct_bringup.campaign.shard_size import shard_size_of
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.verdict.limits import packaged_limits

GAIN = 'controllers.pi.proportional_gain'


def rows_of(**content: Any) -> list[dict[str, Any]]:
    """Return the rows of all runs of a specification, computed as one shard."""
    campaign = Campaign(spec_of(content, Path()))
    found = Scorer(packaged_limits()).scored(campaign.planned(0, campaign.runs))
    return [dict(each.row()) for each in found]


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


@pytest.mark.parametrize(
    ('content', 'size'),
    [
        ({'controllers': ['pi', 'ls8']}, 1000),
        ({'controllers': ['pi', 'mpc4']}, 80),
        ({'controllers': ['pi', 'ls8'], 'scenario': 'thesis_sticking'}, 80),
    ],
)
def test_shards_of_linear_runs_are_large_as_they_are_computed_together(
    content: dict[str, Any], size: int
) -> None:
    wear = {'wear_gain': {'distribution': 'uniform', 'low': 0.8, 'high': 1.2}}
    random = {'samples': 2000, 'vary': wear}
    campaign = Campaign(spec_of({**content, 'random': random}, Path()))
    assert shard_size_of(campaign) == size
