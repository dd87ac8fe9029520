# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Run a campaign specification from Python and iterate over its rows.

    from ddct_bringup.campaign.run_specification import run_specification
    for row in run_specification(spec_of({...}, Path.cwd()), packaged_limits()):
        print(row['wear_gain'], row['state'])
"""

from collections.abc import Callable, Generator, Iterator
from pathlib import Path

import pyarrow.parquet as parquet

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.conduct import carry_out, require_going_on
from ddct_bringup.campaign.rows import Row
from ddct_bringup.campaign.scored import scored_runs
from ddct_bringup.campaign.spec import CampaignSpec
from ddct_bringup.verdict.limits import Limits


def run_specification(
    spec: CampaignSpec,
    limits: Limits,
    *,
    out: Path | None = None,
    resume: bool = False,
    workers: int | None = None,
    stopped: Callable[[], bool] = lambda: False,
) -> Generator[Row, None, None]:
    """
    Yield the row of every run of a specification, in the order of their indices.

    Without `out` rows are computed while they are consumed, by `workers` processes, and are kept
    nowhere; what is left when the iterator is closed is not computed. With `out` the campaign is
    carried out into that folder first, where `resume` goes on with what is done. The rows are the
    same. Raise DdctError for a specification that cannot run, KeyboardInterrupt when `stopped()`
    becomes true.
    """
    campaign = Campaign(spec)
    if out is not None:
        results = carry_out(campaign, limits, out, workers=workers, resume=resume, stopped=stopped)
        yield from _rows(results)
        return
    campaign.require_sound()
    with scored_runs(campaign, limits, workers=workers, floors=spec.floors) as found:
        for scored in found:
            require_going_on(stopped)
            yield scored.row()


def _rows(results: Path) -> Iterator[Row]:
    """Yield the rows of a results file, a group at a time."""
    with parquet.ParquetFile(results) as file:
        for batch in file.iter_batches():
            yield from batch.to_pylist()
