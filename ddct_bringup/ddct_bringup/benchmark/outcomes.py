# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Outcomes of one controller's runs, shares of them, and distributions over the successes."""

import numpy as np

from ddct_bringup.benchmark.case_rows import CASE
from ddct_bringup.benchmark.evaluated import Columns
from ddct_bringup.benchmark.result_types import RunShare, ValueSpread, WorstCase
from ddct_bringup.benchmark.statistics.case_figures import CaseFigures
from ddct_bringup.campaign.rows import STATE
from ddct_bringup.campaign_report.statistics import outcome
from ddct_bringup.campaign_report.statistics.spread import spread_of
from ddct_bringup.verdict.state import ENGAGED


def share_of(runs: int, among: int) -> RunShare:
    """Return a share of runs with its Clopper-Pearson interval; None of no runs."""
    found = outcome.Share(runs, 0, among)
    return RunShare(
        runs=runs,
        share=found.share,
        interval=found.interval() if among else None,
    )


def outcomes_in(columns: Columns) -> np.ndarray:
    """Return the outcome of each run of a controller, (cases,), as in a campaign."""
    return outcome.outcomes_of(columns['valid'], columns[STATE])


def successes_in(columns: Columns) -> np.ndarray:
    """Return whether each run of a controller is a success; a run that is invalid is none."""
    return np.asarray(outcomes_in(columns) == ENGAGED)


def share_of_successes(columns: Columns) -> RunShare:
    """Return the share of the runs that are a success."""
    success = successes_in(columns)
    return share_of(int(np.sum(success)), len(success))


def case_figures_in(columns: Columns) -> CaseFigures:
    """Return the successes and the five figures of a controller."""
    return CaseFigures.of(successes_in(columns), columns)


def spread_in(columns: Columns, values: np.ndarray) -> ValueSpread:
    """Return the distribution of (cases,) values over the successes that have one."""
    found = spread_of(values, outcomes_in(columns))
    place = found.worst_engaged
    worst = None if place is None else float(values[place])
    return ValueSpread(
        quantiles=found.quantiles,
        with_value=found.with_value,
        worst=WorstCase(worst, None if place is None else int(columns[CASE][place])),
    )
