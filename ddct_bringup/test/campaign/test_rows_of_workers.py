# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The rows of runs are the same with any workers, in memory and in the folder of a campaign."""

from pathlib import Path
from typing import Any

import pytest
from pyarrow import parquet

from ddct_bringup.campaign import scored
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.columns import runs_table, schema_of
from ddct_bringup.campaign.conduct import carry_out
from ddct_bringup.campaign.scored import scored_runs
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.many_runs import blocks, engine
from ddct_bringup.many_runs.local_workers import ThisProcess
from ddct_bringup.verdict.limits import packaged_limits

VARY = {'vehicle.mass_kg': {'distribution': 'uniform', 'low': 1000, 'high': 2000}}
CONTENT: dict[str, Any] = {
    'controllers': ['pi', 'mpc4'],
    'grid': {'wear_gain': [0.7, 1.0], 'duration_s': [0.7]},
    'random': {'samples': 3, 'vary': VARY},
}


def campaign() -> Campaign:
    return Campaign(spec_of(CONTENT, Path()))


def rows_in_memory(workers: int) -> list[dict[str, Any]]:
    made = campaign()
    with scored_runs(made, packaged_limits(), workers=workers) as found:
        return runs_table(schema_of(made.spec), list(found)).to_pylist()


@pytest.mark.process
def test_rows_in_memory_are_the_same_with_any_workers() -> None:
    rows = [rows_in_memory(count) for count in (1, 2, 3)]
    assert [row['index'] for row in rows[0]] == list(range(12))
    assert rows[0] == rows[1] == rows[2]
    assert {row['path'] for row in rows[0]} == {'serial'}


@pytest.mark.process
def test_rows_in_a_folder_are_the_same_with_any_workers(tmp_path: Path) -> None:
    first, second = (
        parquet.read_table(
            carry_out(campaign(), packaged_limits(), tmp_path / str(count), workers=count)
        ).to_pylist()
        for count in (1, 2)
    )
    assert [row['index'] for row in first] == list(range(12))
    assert first == second
    assert {row['path'] for row in first} == {'serial', 'vectorised'}
    for stored, row in zip(first, rows_in_memory(1), strict=True):
        if stored['path'] == 'serial':
            assert stored == row


def test_the_first_row_comes_before_the_last_run_is_computed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    computed: list[int] = []
    planned = scored.RunSet.planned

    def counted(self: scored.RunSet, first: int, last: int) -> Any:
        computed.extend(range(first, last))
        return planned(self, first, last)

    monkeypatch.setattr(engine, 'workers_of', lambda *_: ThisProcess())
    monkeypatch.setattr(blocks, '_BLOCKS', 6)
    monkeypatch.setattr(scored.RunSet, 'planned', counted)
    with scored_runs(campaign(), packaged_limits(), workers=1) as found:
        assert next(found).index == 0
    assert max(computed) < 2
