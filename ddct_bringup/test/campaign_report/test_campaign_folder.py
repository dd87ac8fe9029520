# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Reading a campaign: rows and nominal values, and one line for each incomplete folder."""

import json
import re
import shutil
from pathlib import Path

import pyarrow.parquet as parquet
import pytest
from made_campaign import GRID, leave_out_figure, make_campaign, seal

from ddct_bringup.api import DdctError, document, read_campaign
from ddct_bringup.campaign.conduct import RESULTS
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.campaign_report.folder import PAGE, SUMMARY
from ddct_bringup.campaign_report.reading import nominal_values
from ddct_bringup.manifest.manifest import MANIFEST
from ddct_bringup.programs.campaign import main
from ddct_bringup.verdict.state import ENGAGED, INVALID

pytestmark = pytest.mark.slow


@pytest.fixture(autouse=True)
def no_figure(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only test_campaign_page.py is about the figure of a page."""
    leave_out_figure(monkeypatch)


RANDOM = {
    'controllers': ['pi'],
    'random': {
        'samples': 30,
        'vary': {'wear_gain': {'distribution': 'uniform', 'low': 0.6, 'high': 1.4}},
    },
}


def worn_fails(run):
    return 'not_engaged' if run.varied['wear_gain'] < 0.9 else ENGAGED


@pytest.fixture(scope='module')
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_campaign(tmp_path_factory.mktemp('made') / 'wear', GRID, worn_fails)


@pytest.fixture
def folder(made: Path, tmp_path: Path) -> Path:
    return shutil.copytree(made, tmp_path / 'wear')


def test_a_data_frame_has_a_row_per_run_and_comes_with_the_summary(folder: Path) -> None:
    table, summary = read_campaign(folder)
    assert table.index.tolist() == list(range(12))
    failed = table[table.state != ENGAGED]
    assert failed.wear_gain.unique().tolist() == [0.8]
    assert [each.failed.count for each in summary.groups] == [2, 2]
    assert table['engagement_time_s'].dtype == float


def test_a_notebook_has_the_tables_of_the_page(folder: Path) -> None:
    often = document(folder).table('How often engagement fails')
    assert [row[3] for row in often.rows] == [6, 6]


def test_show_prints_the_tables_and_writes_summary_and_page(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(['show', str(folder)]) == 0
    printed = capsys.readouterr().out
    assert '33.3 %' in printed
    assert re.search(r'  0\.8\s+\(not', printed)
    assert re.search(r'vehicle\.mass_kg\s.*1500', printed, re.DOTALL)
    assert 'pi less ls8' in printed
    assert f'ddct campaign replay {folder} --index I' in printed
    assert (folder / PAGE).is_file()
    assert json.loads((folder / SUMMARY).read_text())['runs'] == 12


def test_show_writes_json_and_csv_and_then_no_table_to_standard_output(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(['show', str(folder), '--json', '-']) == 0
    assert json.loads(capsys.readouterr().out) == json.loads((folder / SUMMARY).read_text())
    assert main(['show', str(folder), '--csv', '-']) == 0
    header, *rows = capsys.readouterr().out.splitlines()
    assert header.startswith('"index","controller","path","seed","wear_gain"')
    assert len(rows) == 12


@pytest.mark.parametrize('name', ['wear.svg'])
def test_show_draws_the_distributions(folder: Path, tmp_path: Path, name: str) -> None:
    file = tmp_path / name
    assert main(['show', str(folder), '--figure', str(file)]) == 0
    assert file.read_bytes()[:5] in (b'\x89PNG\r', b'<?xml')


def test_a_figure_of_another_kind_is_refused_before_anything_is_written(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(['show', str(folder), '--figure', 'wear.txt']) == 1
    assert 'wear.txt: name a file that ends in .png, .svg or .html' in capsys.readouterr().err
    assert not (folder / PAGE).exists()


def test_text_of_a_row_cannot_control_the_terminal(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = make_campaign(tmp_path / 'evil', GRID, lambda run: INVALID, reason='\x1b[31mred')
    assert main(['show', str(made), '--csv', '-']) == 0
    assert '"\\x1b[31mred"' in capsys.readouterr().out


def test_the_interval_of_random_samples_is_shown(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = make_campaign(tmp_path / 'random', RANDOM, worn_fails)
    assert main(['show', str(made)]) == 0
    (group,) = read_campaign(made).summary.groups
    failed = group.failed
    low, high = failed.low, failed.high
    assert low < failed.value < high
    assert f'{100 * low:.1f} to {100 * high:.1f} %' in capsys.readouterr().out


def test_nominal_values_are_those_of_the_scenario_and_the_settings_without_variation() -> None:
    content = {
        'controllers': ['pi'],
        'grid': {
            'wear_gain': [0.5],
            'vehicle.mass_kg': [2000.0],
            'actuator.delay_s': [0.02],
            'engine.factor': [1.2],
        },
    }
    found = nominal_values(spec_of(content, Path()))
    assert found == {
        'wear_gain': 1.0,
        'vehicle.mass_kg': 1500.0,
        'actuator.delay_s': 0.01,
        'engine.factor': 1.0,
    }


def complaint(folder: Path, capsys: pytest.CaptureFixture[str]) -> str:
    """Return the one line of error of `show`."""
    assert main(['show', str(folder)]) == 1
    captured = capsys.readouterr()
    assert captured.out == ''
    (line,) = captured.err.splitlines()
    with pytest.raises(DdctError):
        read_campaign(folder)
    return line


def test_a_folder_that_is_no_campaign_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert 'no manifest.json in it' in complaint(tmp_path, capsys)


def test_a_campaign_that_was_interrupted_can_go_on(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / RESULTS).unlink()
    assert 'not finished: give --resume' in complaint(folder, capsys)


@pytest.mark.parametrize('keep', [0, 10, -30])
def test_damaged_results_are_reported(
    folder: Path, capsys: pytest.CaptureFixture[str], keep: int
) -> None:
    path = folder / RESULTS
    path.write_bytes(path.read_bytes()[:keep])
    seal(folder)
    assert 'it is damaged' in complaint(folder, capsys)


def test_results_that_lack_a_row_are_not_those_of_the_manifest(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = parquet.read_table(folder / RESULTS)
    parquet.write_table(table.slice(0, 11), folder / RESULTS)
    seal(folder)
    assert 'its rows are not the 12 runs' in complaint(folder, capsys)


def test_a_newer_version_of_the_results_or_the_manifest_is_named(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = parquet.read_table(folder / RESULTS)
    newer = table.replace_schema_metadata({'schema_version': '5'})
    parquet.write_table(newer, folder / RESULTS)
    seal(folder)
    assert 'schema_version is 5, this version reads up to 4' in complaint(folder, capsys)
    manifest = json.loads((folder / MANIFEST).read_text())
    (folder / MANIFEST).write_text(json.dumps({**manifest, 'schema_version': 9}))
    assert 'schema_version is 9' in complaint(folder, capsys)
