"""Read a finished campaign."""

from pathlib import Path
from typing import Any, NamedTuple

from ddct_bringup.api.runs import pandas_module
from ddct_bringup.campaign.columns import INDEX
from ddct_bringup.campaign.manifest import Manifest
from ddct_bringup.campaign_report.folder import read_table, results_of
from ddct_bringup.campaign_report.summary import Summary, summary_of


class CampaignResults(NamedTuple):
    """What a campaign left."""

    table: Any
    """A pandas DataFrame with a row per run, by its index: what was varied, metrics, verdict."""
    summary: Summary
    """The content of `summary.json`."""


def read_campaign(folder: str | Path) -> CampaignResults:
    """Return the rows and the summary of a finished campaign; raise DdctError without one."""
    pandas_module()
    manifest = Manifest.read(Path(folder))
    table = read_table(Path(folder), manifest)
    summary = summary_of(results_of(manifest, table))
    return CampaignResults(table.to_pandas().set_index(INDEX), summary)
