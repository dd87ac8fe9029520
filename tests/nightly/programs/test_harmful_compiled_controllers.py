# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Compiled code that crashes in some runs ends those alone, in a benchmark and in a tuning."""

from pathlib import Path

import pyarrow.parquet as parquet
import pytest
from small_benchmark import judge, use_small_release
from small_tuning import made_tuning
from support.c_controllers import ENDS, harmed_on_a_hill, harmful

from ddct_bringup.campaign.arrow_columns import read_parquet
from ddct_bringup.campaign.conduct import RESULTS
from ddct_bringup.tuning.tables import TRIALS

pytestmark = [pytest.mark.slow, pytest.mark.compiler]


def test_a_benchmark_has_the_reason_of_each_crash_in_development_and_held_out_cases(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    use_small_release(tmp_path, monkeypatch)
    file = harmed_on_a_hill(tmp_path)
    assert judge(tmp_path / 'out', file, '--workers', '2') == 0
    tables = list((tmp_path / 'out').rglob(RESULTS))
    assert len(tables) == 2
    for path in tables:
        rows = parquet.read_table(path).to_pandas()
        mine = rows[rows.controller == 'harmed']
        hill = mine.scenario == 'launch_hill'
        assert (hill.sum(), len(mine)) == (3, 6)
        assert mine.valid.tolist() == (~hill).tolist()
        assert mine[hill].reason.str.contains(f'{ENDS[3]} when update', regex=False).all()
        assert rows[rows.controller != 'harmed'].valid.all()


def test_trials_of_a_tuning_go_on_after_one_that_crashes(
    tmp_path: Path,
) -> None:
    pytest.importorskip('optuna', reason='Optuna, an optional extra, is absent: EXTRAS=tune')
    vary = {'wear_gain': {'distribution': 'uniform', 'low': 0.98, 'high': 1.02}}
    found = made_tuning(
        tmp_path / 'out',
        controller=harmful(tmp_path),
        parameters={'fault': {'low': 0.0, 'high': 3.99}},
        trials=8,
        campaign={'scenario': 'thesis', 'random': {'samples': 1, 'vary': vary}},
    )
    trials = read_parquet(found / TRIALS).to_pylist()
    whole = {each['number'] for each in trials if each['fault'] < 1.0}
    assert 0 < len(whole) < len(trials) == 8
    for each in trials:
        assert (each['state'] != 'infeasible') == (each['number'] in whole)
