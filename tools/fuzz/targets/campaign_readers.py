# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Readers of the files of a campaign, and of the JSON with which `verify` compares its own."""

import json
import shutil
from functools import partial
from pathlib import Path

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.columns import read_row
from ddct_bringup.campaign.conduct import RESULTS, carry_out
from ddct_bringup.campaign.plan import CampaignPlan, RecordedCampaign
from ddct_bringup.campaign.spec import read_spec, spec_of
from ddct_bringup.campaign_report.folder import SUMMARY
from ddct_bringup.campaign_report.reading import grouped_rows, read_table
from ddct_bringup.evaluation.summarise import summary_of
from ddct_bringup.evaluation.summary import Summary, SummaryFile
from ddct_bringup.manifest.manifest import (
    ITSELF,
    MANIFEST,
    file_digest,
    read_manifest,
)
from ddct_bringup.run.output_folder import MARKER
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verification.comparison import Comparison, plain_json, recorded_json
from ddct_bringup.verification.result import RepetitionResult
from ddct_plant.files.json_records import read_json
from fuzz.reader import Read, Reader

_TEMPLATE = Path(__file__).resolve().parents[3] / 'docs' / 'templates' / 'campaign.yaml'
_SPEC = {'controllers': ['pi', 'ls8'], 'grid': {'wear_gain': [0.8, 1.2], 'duration_s': [0.7]}}
_LAST = 3


def campaign_readers(folder: Path) -> list[Reader]:
    """Return the readers of a campaign's files; a good campaign is carried out in a folder."""
    made = folder / 'campaign'
    carry_out(Campaign(spec_of(_SPEC, folder)), packaged_limits(), made, workers=1)
    results = (made / RESULTS).read_bytes()
    plan = json.dumps(read_manifest(made).campaigns[ITSELF]).encode()
    summary = plain_json(SummaryFile.of(_summary(made)))
    return [
        Reader('campaign', 'mine.yaml', read_spec, (_TEMPLATE.read_bytes(),)),
        Reader('campaign_plan', 'plan.json', partial(read_json, CampaignPlan), (plan,)),
        Reader('results', RESULTS, _summary_beside(made), (results,)),
        Reader('result_row', RESULTS, lambda file: read_row(file, _LAST, _LAST + 1), (results,)),
        Reader(
            'summary', SUMMARY, _compared(plain_json(summary)), (json.dumps(summary).encode(),)
        ),
    ]


def _summary(folder: Path) -> Summary:
    recorded = RecordedCampaign.read(folder)
    return summary_of(grouped_rows(recorded, read_table(folder, recorded)))


def _summary_beside(made: Path) -> Read:
    """Return a reader of results, with the manifest of a campaign and their digest as they are."""
    manifest = read_manifest(made)

    def read(file: Path) -> object:
        for name in (MARKER, MANIFEST):
            shutil.copy(made / name, file.parent)
        manifest.with_files({RESULTS: file_digest(file)}).write(file.parent)
        return _summary(file.parent)

    return read


def _compared(again: object) -> Read:
    """Return a reader that compares a recorded file with `again`, as all of `verify` do."""

    def read(file: Path) -> object:
        comparison = Comparison()
        comparison.add_nested('', recorded_json(file), again)
        return RepetitionResult.of(file.name, comparison, same_environment=True)

    return read
