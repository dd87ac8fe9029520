# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A campaign's folder that was edited, with its digests removed, is refused in one line."""

import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as parquet
import pytest
from in_this_process import in_this_process
from made_campaign import seal
from refusals import refused
from verified import edit_manifest

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.columns import merge, read_row, schema_of
from ddct_bringup.campaign.conduct import RESULTS, SHARDS, carry_out
from ddct_bringup.campaign.plan import RecordedCampaign
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.campaign_report.reading import read_table
from ddct_bringup.manifest.manifest import read_manifest
from ddct_bringup.many_runs import blocks
from ddct_bringup.programs.campaign import main
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.base.errors import DdctError

SPEC: dict[str, Any] = {
    'controllers': ['pi', 'ls8'],
    'grid': {'wear_gain': [0.7, 1.0], 'duration_s': [0.7]},
}
RUNS = 4


@pytest.fixture(scope='module', autouse=True)
def small_shards() -> Iterator[None]:
    """Let each case be a shard."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(blocks, '_TOGETHER_LEAST', 1)
        yield


@pytest.fixture(scope='module')
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a finished campaign."""
    out = tmp_path_factory.mktemp('whole') / 'campaign'
    with in_this_process():
        carry_out(Campaign(spec_of(SPEC, Path())), packaged_limits(), out)
    return out


@pytest.fixture
def out(whole: Path, tmp_path: Path) -> Path:
    """Return a copy of the folder without digests of files."""
    copy = shutil.copytree(whole, tmp_path / 'campaign')
    replace(read_manifest(copy), files={}).write(copy)
    return copy


def resumed(out: Path) -> list[int]:
    """Go on with the campaign; return the first runs of the shards that were computed."""
    with in_this_process() as workers:
        carry_out(Campaign(spec_of(SPEC, Path())), packaged_limits(), out, resume=True)
    return workers.computed


def replayed(out: Path) -> int:
    """Return the exit code of making a run again."""
    return main(['replay', str(out), '--index', '0', '--out', str(out.parent / 'again')])


def edit(out: Path, **changes: Any) -> None:
    """Change values of the plan in the manifest."""
    edit_manifest(out, lambda content: content['campaigns']['.'].update(changes))


@pytest.mark.parametrize(
    'changes',
    [
        {'runs': RUNS // 2},
        {'runs': RUNS + 3},
        {'runs': 9_999_999},
        {'shard_size': 3},
        {'spec': {}},
    ],
)
def test_a_manifest_that_does_not_follow_from_the_specification_is_not_resumed(
    out: Path, changes: dict[str, Any]
) -> None:
    before = (out / RESULTS).read_bytes()
    edit(out, **changes)
    with refused(DdctError, *changes, place='campaign'):
        resumed(out)
    assert (out / RESULTS).read_bytes() == before


def test_a_campaign_is_not_repeated_with_another_number_of_runs(whole: Path) -> None:
    recorded = RecordedCampaign.read(whole)
    more = replace(recorded, plan=replace(recorded.plan, runs=RUNS + 3))
    with refused(DdctError, 'runs', place='campaign'):
        more.campaign()


def of_one_row_repeated(file: Path, count: int) -> None:
    """Let a file of rows have its first row many times."""
    table = parquet.read_table(file)
    rows = table.to_pylist()[:1] * count
    parquet.write_table(pa.Table.from_pylist(rows, schema=table.schema), file)


def test_results_with_more_rows_than_runs_are_refused_by_all_that_reads_them(out: Path) -> None:
    of_one_row_repeated(out / RESULTS, RUNS + 1)
    seal(out)
    recorded = RecordedCampaign.read(out)
    with pytest.raises(DdctError, match=f'it has {RUNS + 1} rows, not {RUNS}'):
        read_table(out, recorded)
    with pytest.raises(DdctError, match=f'it has {RUNS + 1} rows, not {RUNS}'):
        read_row(out / RESULTS, 0, recorded.plan.runs)


@pytest.mark.parametrize('count', [0, 2])
def test_a_shard_with_another_number_of_rows_is_not_merged(out: Path, count: int) -> None:
    shards = dict.fromkeys(sorted((out / SHARDS).iterdir()), 2)
    of_one_row_repeated(list(shards)[1], count)
    before = (out / RESULTS).read_bytes()
    schema = schema_of(Campaign(spec_of(SPEC, Path())).spec)
    with pytest.raises(DdctError, match=r'0001.parquet: .*\(it has .* rows.*\): remove'):
        merge(shards, 2, schema, out / RESULTS, 'advice')
    assert (out / RESULTS).read_bytes() == before
    assert not list(out.glob('.*.partial'))


def test_results_without_a_digest_are_refused_until_they_are_computed_again(out: Path) -> None:
    with refused(DdctError, RESULTS, place='campaign') as caught:
        read_table(out, RecordedCampaign.read(out))
    assert '--resume' in str(caught.value)
    assert replayed(out) == 1
    resumed(out)
    assert len(read_table(out, RecordedCampaign.read(out))) == RUNS
