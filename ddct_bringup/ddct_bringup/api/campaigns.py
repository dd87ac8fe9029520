# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Run sweeps and campaigns, many runs each, from Python."""

import warnings
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from ddct_bringup.api.arguments import plain
from ddct_bringup.api.shell.campaigns import carry_out_campaign
from ddct_bringup.api.shell.sweeps import planned_sweep
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.columns import INDEX
from ddct_bringup.campaign.plan import RecordedCampaign
from ddct_bringup.campaign.spec import read_spec, spec_of
from ddct_bringup.campaign_report.reading import grouped_rows, read_table
from ddct_bringup.evaluation.summarise import summary_of
from ddct_bringup.evaluation.summary import Summary
from ddct_bringup.sweep.axis import Axis, axis, axis_of
from ddct_bringup.verdict.limits import load_limits


class CampaignResults(NamedTuple):
    """Results of a finished campaign."""

    table: Any
    """pandas DataFrame with a row per run, by its index: varied values, metrics, verdict."""
    summary: Summary
    """What came out, by group and pair, as in `summary.json`."""


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
    Compute a campaign into the folder `out`, as `ddct campaign` does, and return its results.

    `spec` is a file, or the content of one as a mapping; files that a mapping names are relative
    to the working directory.
    """
    given = spec_of(spec, Path.cwd()) if isinstance(spec, Mapping) else read_spec(spec)
    judged_by = load_limits(limits)
    carry_out_campaign(
        Campaign(given), judged_by, Path(out), workers=workers, scheduler=scheduler, resume=resume
    )
    return read_campaign(out)


def read_campaign(folder: str | Path) -> CampaignResults:
    """Return the rows and the summary of a finished campaign; raise DdctError without one."""
    recorded = RecordedCampaign.read(Path(folder))
    table = read_table(Path(folder), recorded)
    summary = summary_of(grouped_rows(recorded, table))
    return CampaignResults(table.to_pandas().set_index(INDEX), summary)


def sweep(
    controllers: str | Iterable[Any] | Mapping[str, Any],
    over: Mapping[str, str | Iterable[Any]],
    *,
    limits: str | Path | None = None,
    **options: Any,
) -> Any:
    """
    Run controllers over values, headless on all cores; return a pandas DataFrame.

    `controllers` are as for `compare`, `options` as for `run`. `over` maps a key to its values, or
    to the text 'START:STOP:COUNT'; with several keys every combination runs. A row per run has the
    controller, the values under their keys, every figure and metric that it alone gives, `valid`,
    `reason`, `state` and `why`.
    """
    axes = [_axis(key, over[key]) for key in over]
    planned = planned_sweep(controllers, axes, load_limits(limits), warnings.warn, **options)
    with planned.runs() as runs:
        return planned.table(list(runs)).to_pandas().set_index(INDEX)


def _axis(key: str, values: str | Iterable[Any]) -> Axis:
    if isinstance(values, str):
        return axis_of(f'{key}={values}')
    return axis(key, [plain(value) for value in values])
