# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Results of other versions are read with the columns that they have."""

from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as parquet
import pytest
from made_campaign import GRID, leave_out_figure, make_campaign, seal
from verified import edit_manifest

from ddct_bringup.api import DdctError, read_campaign
from ddct_bringup.campaign.conduct import RESULTS
from ddct_bringup.campaign_report.folder import PAGE
from ddct_bringup.programs.campaign import main

pytestmark = pytest.mark.slow

ABSENT, UNKNOWN = 'peak_jerk_m_s3', 'metric_of_tomorrow'


@pytest.fixture(autouse=True)
def no_figure(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only test_campaign_page.py is about the figure of a page."""
    leave_out_figure(monkeypatch)


@pytest.fixture
def changed(tmp_path: Path) -> Path:
    """Return a campaign without a column of this version, and with one of another."""
    made = make_campaign(tmp_path / 'changed', GRID)
    table = parquet.read_table(made / RESULTS).drop_columns([ABSENT])
    table = table.append_column(UNKNOWN, pa.array([7.5] * len(table)))
    parquet.write_table(table, made / RESULTS)
    return seal(made)


def test_the_terminal_and_the_page_name_the_missing_columns(
    changed: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(['show', str(changed), '--figure', str(changed / 'wear.html')]) == 0
    printed = capsys.readouterr().out
    assert f'Results of another version:\nwithout {ABSENT}\n' in printed
    assert 'Results of another version' in (changed / PAGE).read_text(encoding='utf-8')


def test_missing_columns_stay_missing_and_unknown_ones_are_kept(
    changed: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table, summary = read_campaign(changed)
    assert ABSENT not in table
    assert set(table[UNKNOWN]) == {7.5}
    assert summary.other_version.absent == (ABSENT,)
    assert summary.other_version.unknown == (UNKNOWN,)
    names = summary.groups[0].quantities
    assert ABSENT not in names
    assert 'engagement_time_s' in names
    assert main(['show', str(changed), '--csv', '-']) == 0
    header, *rows = capsys.readouterr().out.splitlines()
    assert f'"{UNKNOWN}"' in header
    assert all(row.endswith('7.5') for row in rows)


@pytest.mark.parametrize('name', ['state', 'wear_gain'])
def test_without_a_column_that_is_needed_the_line_names_it(changed: Path, name: str) -> None:
    parquet.write_table(
        parquet.read_table(changed / RESULTS).drop_columns([name]), changed / RESULTS
    )
    seal(changed)
    with pytest.raises(DdctError, match=f'it has no column {name}'):
        read_campaign(changed)


def test_a_key_of_another_version_is_read_without_its_nominal_value(
    changed: Path,
) -> None:
    def rename(manifest):
        spec = manifest['campaigns']['.']['spec']
        grid = spec['grid']
        spec['grid'] = {'wear_of_tomorrow': grid.pop('wear_gain'), **grid}

    edit_manifest(changed, rename)
    table = parquet.read_table(changed / RESULTS)
    names = [{'wear_gain': 'wear_of_tomorrow'}.get(each, each) for each in table.column_names]
    renamed = table.rename_columns(names).replace_schema_metadata(table.schema.metadata)
    parquet.write_table(renamed, changed / RESULTS)
    seal(changed)
    summary = read_campaign(changed).summary
    assert 'wear_of_tomorrow' in summary.other_version.no_nominal
    wear, mass = summary.groups[0].boundaries
    assert (wear.nominal, wear.start) == (None, 1.0)
    assert mass.start == 1300.0
    assert main(['show', str(changed)]) == 0
