# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The folder of a campaign whose rows are made by hand."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pyarrow as pa
import pytest

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.columns import parquet_bytes, schema_of
from ddct_bringup.campaign.conduct import RESULTS
from ddct_bringup.campaign.plan import CampaignPlan
from ddct_bringup.campaign.rows import METRIC_COLUMNS
from ddct_bringup.campaign.run_set import PlannedRow
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.manifest.inputs import InputFiles
from ddct_bringup.manifest.limits import NamedLimits
from ddct_bringup.manifest.manifest import CAMPAIGN, ITSELF, begin_manifest, finish_manifest
from ddct_bringup.run.output_folder import mark_folder
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import ENGAGED, INVALID

GRID = {
    'controllers': ['pi', 'ls8'],
    'grid': {'wear_gain': [0.8, 1.0, 1.2], 'vehicle.mass_kg': [1300.0, 1500.0]},
}
"""Twelve runs."""


def make_campaign(
    folder: Path,
    content: Mapping[str, Any],
    state_of: Callable[[PlannedRow], str] = lambda run: ENGAGED,
    **cells: Any,
) -> Path:
    """
    Write manifest, results and digests of the runs of a specification.

    A test that edits a file writes the digests again, with `seal`.

    The first metric of a run is its index, the next twice that, and so on.
    """
    campaign = Campaign(spec_of(content, folder))
    schema = schema_of(campaign.spec)
    rows = []
    for index in range(campaign.runs):
        run = campaign.run(index)
        state = state_of(run)
        rows.append(
            dict.fromkeys(schema.names)
            | {name: float(place * index) for place, name in enumerate(METRIC_COLUMNS, 1)}
            | {'index': index, 'controller': run.controller.name, 'path': 'serial'}
            | {'valid': state != INVALID, 'reason': ''}
            | {'state': state, 'why': '', **run.varied, **cells}
        )
    folder.mkdir(parents=True, exist_ok=True)
    if not any(folder.iterdir()):
        mark_folder(folder)
    inputs = InputFiles(folder)
    plan = CampaignPlan.of(campaign, NamedLimits.of(packaged_limits(), inputs), folder)
    begin_manifest(folder, CAMPAIGN, {}, inputs, {ITSELF: plan})
    (folder / RESULTS).write_bytes(parquet_bytes(pa.Table.from_pylist(rows, schema)))
    return seal(folder)


def leave_out_figure(patch: pytest.MonkeyPatch) -> None:
    """Draw no figure on the pages of campaigns, which takes most of the time of a page."""
    patch.setattr('ddct_bringup.campaign_report.document._charts', lambda *given: iter(()))


def seal(folder: Path) -> Path:
    """Write the digests of the files of a campaign as they are now, and return the folder."""
    finish_manifest(folder)
    return folder
