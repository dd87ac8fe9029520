# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Each row has the seed of its run, and a single run with that seed has the scores of the row."""

from pathlib import Path
from typing import Any

import pyarrow.parquet as parquet
import pytest
from in_this_process import in_this_process

from ddct_bringup import api
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.conduct import RESULTS, carry_out
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.verdict.limits import packaged_limits

KEY = 'sensors.engine_speed.noise_rad_s'
NOISY: dict[str, Any] = {
    'controllers': ['pi', 'ls8'],
    'seed': 4,
    'random': {
        'samples': 2,
        'vary': {KEY: {'distribution': 'uniform', 'low': 1, 'high': 3}},
    },
}


def rows_of(content: dict[str, Any], out: Path) -> list[dict[str, Any]]:
    with in_this_process():
        carry_out(Campaign(spec_of(content, Path())), packaged_limits(), out)
    return parquet.read_table(out / RESULTS).to_pylist()


def test_a_single_run_with_the_seed_of_a_row_has_its_scores(tmp_path: Path) -> None:
    rows = rows_of(NOISY, tmp_path / 'out')
    assert len({row['seed'] for row in rows}) == 2
    assert [row['seed'] for row in rows[:2]] == [row['seed'] for row in rows[2:]]
    for row in rows:
        single = api.run(row['controller'], seed=row['seed'], set={KEY: row[KEY]})
        deviation = pytest.approx(row['torsion_speed_std_rpm'], rel=1e-9, abs=0.0)
        assert single.metrics['torsion_speed_std_rpm'] == deviation
        other = api.run(row['controller'], seed=row['seed'] + 1, set={KEY: row[KEY]})
        assert other.metrics['torsion_speed_std_rpm'] != deviation


@pytest.mark.parametrize('where', ['grid', 'random'])
def test_a_seed_that_varies_has_one_column(tmp_path: Path, where: str) -> None:
    vary = {'seed': {'distribution': 'uniform', 'low': 5, 'high': 9, 'step': 1}}
    content: dict[str, Any] = {'controllers': ['pi'], 'grid': {'duration_s': [0.7]}}
    if where == 'grid':
        content['grid']['seed'] = [5, 9]
    else:
        content['random'] = {'samples': 2, 'vary': vary}
    rows = rows_of(content, tmp_path / 'out')
    assert all(row['seed'] in range(5, 10) for row in rows)
    assert list(rows[0])[:5] == ['index', 'controller', 'path', 'seed', 'duration_s']
