# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Carry out a campaign with its page, make a row again, and write what came out to files."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ddct_bringup.api import shell
from ddct_bringup.api.shell.kept_run import keep_run
from ddct_bringup.bag.recording import Recording
from ddct_bringup.campaign.arrow_columns import table_csv
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.columns import (
    PATH,
    VECTORISED_RTOL,
    compared_in,
    differences,
    read_row,
    runs_table,
    schema_of,
)
from ddct_bringup.campaign.conduct import RESULTS, carry_out
from ddct_bringup.campaign.plan import RecordedCampaign
from ddct_bringup.campaign.rows import SERIAL, ScoredRow
from ddct_bringup.campaign_report.folder import (
    PAGE,
    scenario_of,
    write_campaign_page,
)
from ddct_bringup.campaign_report.reading import grouped_rows, read_table, require_as_written
from ddct_bringup.evaluation.summary import Summary, SummaryFile
from ddct_bringup.manifest.code import code_digest
from ddct_bringup.manifest.manifest import keep_digests
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.scored_recording import ScoredRecording
from ddct_bringup.verdict.limits import Limits
from ddct_plant.base.errors import DdctError
from ddct_plant.files.json_records import write_json
from ddct_plant.files.output_file import STDOUT, write_text


@dataclass(frozen=True)
class CampaignDone:
    """A finished campaign: its summary, and its files."""

    summary: Summary
    rows: Path
    page: Path


def carry_out_campaign(
    campaign: Campaign, limits: Limits, out: Path, **options: Any
) -> CampaignDone:
    """Carry out a campaign, with the options of `carry_out`, and write its summary and page."""
    rows = carry_out(campaign, limits, out, **options)
    return CampaignDone(write_campaign_page(out), rows, out / PAGE)


@dataclass(frozen=True)
class Replay:
    """A row of a campaign that was made again."""

    index: int
    path: str
    """Path of the row: step by step, or vectorised."""
    differences: list[str]
    """What differs from the row, a line each; none where it came out again."""
    compared: str
    """Number of compared values, and how exactly they were compared."""
    kept: ScoredRecording

    @property
    def document(self) -> 'ReplayDocument':
        """Document of `--json`."""
        return ReplayDocument(self.index, self.path, self.differences)


@dataclass(frozen=True)
class ReplayDocument:
    """Document of `campaign replay --json`."""

    index: int
    """Index of the row."""
    path: str
    """Path of the row: step by step, or vectorised."""
    differences: list[str]
    """What differs from the row, a line each; none where it came out again."""


def replay_row(
    campaign_folder: Path,
    index: int,
    out: Path,
    execute: Callable[[RunPlan, Path], Recording | None],
    complain: Callable[[str], None],
    *,
    layout: str,
    overwrite: bool,
) -> Replay:
    """
    Make the run of a row again, keep its bag in `out`, and compare its scores with the row.

    Raise DdctError for a folder that was altered, and where the run fails.
    """
    recorded = RecordedCampaign.read(campaign_folder)
    limits, campaign = recorded.limits(), recorded.campaign()
    require_as_written(campaign_folder)
    row = read_row(campaign_folder / RESULTS, index, recorded.plan.runs)
    if recorded.origin.code != code_digest():
        complain(f'the campaign is of {recorded.origin.short}, this is another code')
    run = campaign.run(index)
    plan = RunPlan(run.settings, campaign.chosen(index), layout)

    def as_its_row(plan: RunPlan, folder: Path) -> Recording | None:
        try:
            return execute(plan, folder)
        except DdctError as error:
            if row['valid'] or not row['reason']:
                raise
            raise DdctError(f'it fails as its row says ({row["reason"]}): {error}') from error

    kept = keep_run(plan, out, limits, as_its_row, overwrite=overwrite)
    seed = run.settings.case.seed
    again = ScoredRow(index, run.controller.name, seed, run.varied, kept.scores, row[PATH])
    (found_again,) = runs_table(schema_of(campaign.spec), [again]).to_pylist()
    found = differences(row, found_again)
    how = 'bit for bit' if row[PATH] == SERIAL else f'to {VECTORISED_RTOL:g}'
    words = f'its {len(compared_in(row))} figures and words are those of the row, {how}'
    return Replay(index, row[PATH], found, words, kept)


def show_campaign(
    folder: Path, *, json: str | None, csv: str | None, figure: str | None
) -> Summary:
    """Write the page of a campaign anew, and what else is wanted to files; return the summary."""
    summary = write_campaign_page(folder)
    if json:
        write_json(json, SummaryFile.of(summary))
    if csv:
        write_text(csv, table_csv(read_table(folder, RecordedCampaign.read(folder))))
    if figure:
        recorded = RecordedCampaign.read(folder)
        results = grouped_rows(recorded, read_table(folder, recorded))
        shell.write_chart(shell.distributions_chart(results, scenario_of(recorded)), Path(figure))
    keep_digests(file for file in (json, csv, figure) if file not in (None, STDOUT))
    return summary
