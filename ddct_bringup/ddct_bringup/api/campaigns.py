"""Compute campaigns, and read finished ones."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from ddct_bringup.api.runs import pandas_module
from ddct_bringup.campaign.columns import INDEX
from ddct_bringup.campaign.conduct import carry_out
from ddct_bringup.campaign.manifest import Manifest
from ddct_bringup.campaign.runs import Campaign
from ddct_bringup.campaign.spec import read_spec, spec_of
from ddct_bringup.campaign_report.folder import read_table, results_of, write_campaign_page
from ddct_bringup.campaign_report.summary import Summary, summary_of
from ddct_bringup.verdict.limits import load_limits


class CampaignResults(NamedTuple):
    """What a campaign left."""

    table: Any
    """A pandas DataFrame with a row per run, by its index: what was varied, metrics, verdict."""
    summary: Summary
    """The content of `summary.json`."""


def campaign(
    spec: str | Path | Mapping[str, Any],
    out: str | Path,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    resume: bool = False,
    limits: str | Path | None = None,
) -> CampaignResults:
    """
    Compute a campaign into the folder `out`, as `ddct campaign` does, and return what came out.

    `spec` is a file, or what a file holds; files that a mapping names are relative to the working
    directory. A script calls this below `if __name__ == '__main__':`, as its worker processes
    import it.
    """
    pandas_module()
    given = spec_of(spec, Path.cwd()) if isinstance(spec, Mapping) else read_spec(spec)
    judged_by = load_limits(limits)
    carry_out(
        Campaign(given), judged_by, Path(out), workers=workers, scheduler=scheduler, resume=resume
    )
    write_campaign_page(Path(out))
    return read_campaign(out)


def read_campaign(folder: str | Path) -> CampaignResults:
    """Return the rows and the summary of a finished campaign; raise DdctError without one."""
    pandas_module()
    manifest = Manifest.read(Path(folder))
    table = read_table(Path(folder), manifest)
    summary = summary_of(results_of(manifest, table))
    return CampaignResults(table.to_pandas().set_index(INDEX), summary)
