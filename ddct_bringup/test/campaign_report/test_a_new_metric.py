# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A campaign that was finished before a metric was declared stays readable."""

from pathlib import Path

import pyarrow.parquet as parquet
import pytest
from made_campaign import GRID, leave_out_figure, make_campaign

from ddct_bringup.api import read_campaign
from ddct_bringup.campaign import columns
from ddct_bringup.campaign.columns import compared_in, differences, read_row
from ddct_bringup.campaign.conduct import RESULTS
from ddct_bringup.campaign_report import reading
from ddct_bringup.evaluation import grouped_rows
from ddct_bringup.evaluation.quantities import OF_RUNS
from ddct_bringup.metrics.catalogue import JERK_OVER_LEAST, METRICS
from ddct_bringup.programs.campaign import main
from ddct_plant.program.table import Quantity

NEW = Quantity('metric_of_tomorrow', 'new', 's', '.3f', 'a metric that this version has not')


@pytest.fixture
def finished(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a campaign of today; after it a metric is declared."""
    made = make_campaign(tmp_path / 'finished', GRID)
    compared = (*columns.COMPARED, NEW.key)
    for module in (columns, reading):
        monkeypatch.setattr(module, 'COMPARED', compared)
    monkeypatch.setattr(grouped_rows, 'QUANTITIES', {**grouped_rows.QUANTITIES, NEW.key: NEW})
    return made


def test_it_is_shown_and_names_the_metric_that_it_lacks(
    finished: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    leave_out_figure(monkeypatch)
    before = (finished / RESULTS).read_bytes()
    summary = read_campaign(finished).summary
    assert summary.other_version.absent == (NEW.key,)
    assert NEW.key not in summary.groups[0].quantities
    assert main(['show', str(finished)]) == 0
    printed = capsys.readouterr().out
    assert f'Results of another version:\nwithout {NEW.key}\n' in printed
    assert (finished / RESULTS).read_bytes() == before


def test_a_row_without_it_is_compared_with_its_run_made_again(finished: Path) -> None:
    row = read_row(finished / RESULTS, 1, 12)
    assert NEW.key not in compared_in(row)
    assert differences(row, {**row, NEW.key: 1.0}) == []
    assert parquet.read_metadata(finished / RESULTS).num_rows == 12


def test_a_metric_of_which_less_is_not_better_is_not_summarised() -> None:
    assert not METRICS['steps'].smaller_is_better
    of_runs = [each for each in METRICS.values() if not each.from_timing]
    assert [*OF_RUNS] == [
        each.key for each in of_runs if each.smaller_is_better and each is not JERK_OVER_LEAST
    ]
