# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Outcomes of one controller's runs, shares of them, and distributions over the engaged ones."""

from collections.abc import Mapping

import numpy as np

from ddct_bringup.benchmark.case_rows import CASE
from ddct_bringup.benchmark.result_types import RunShare, ValueSpread
from ddct_bringup.campaign_report.statistics import outcome
from ddct_bringup.campaign_report.statistics.spread import spread_of
from ddct_bringup.verdict.state import SUCCESSES

Columns = Mapping[str, np.ndarray]
"""Columns of one controller by name, (cases,) each."""


def share_of(runs: int, among: int) -> RunShare:
    """Return a share of runs with its Clopper-Pearson interval; None of no runs."""
    found = outcome.Share(runs, 0, among)
    return {
        'runs': runs,
        'share': found.share,
        'interval': list(found.interval()) if among else None,
    }


def outcomes_in(columns: Columns) -> np.ndarray:
    """Return the outcome of each run of a controller, (cases,), as in a campaign."""
    return outcome.outcomes_of(columns['valid'], columns['verdict_state'])


def successes_in(columns: Columns) -> np.ndarray:
    """Return whether each run of a controller is a success; a run that is invalid is none."""
    return np.isin(outcomes_in(columns), SUCCESSES)


def spread_in(columns: Columns, values: np.ndarray) -> ValueSpread:
    """Return the distribution of (cases,) values over the engaged runs that have one."""
    found = spread_of(values, outcomes_in(columns))
    place = found.worst_engaged
    worst = None if place is None else float(values[place])
    return {
        **found.quantiles,
        'with_value': found.with_value,
        'worst': {'value': worst, 'case': None if place is None else int(columns[CASE][place])},
    }
