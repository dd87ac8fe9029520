# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Build the summary of a campaign: the content of `summary.json`."""

from dataclasses import replace

from ddct_bringup.campaign.columns import CONTROLLER
from ddct_bringup.campaign_report.failure_summary import (
    NO_SAMPLE,
    attribution_summary,
    boundary_summary,
    case_of,
    failed_summary,
)
from ddct_bringup.campaign_report.results import Group, Results
from ddct_bringup.campaign_report.statistics import attribution, paired
from ddct_bringup.campaign_report.statistics.outcome import CONFIDENCE, METHOD
from ddct_bringup.campaign_report.statistics.spread import ONE_IN, spread_of
from ddct_bringup.campaign_report.summary_types import (
    DifferenceSummary,
    GroupSummary,
    IntervalMethod,
    PairSummary,
    QuantitySummary,
    Summary,
)
from ddct_plant.program.table import Quantity

SCHEMA_VERSION = 2
"""Schema version of `summary.json`."""


def summary_of(results: Results) -> Summary:
    """Return the summary of the results of a campaign."""
    return Summary(
        schema_version=SCHEMA_VERSION,
        runs=results.rows,
        grid=list(results.grid),
        random=list(results.random),
        interval=IntervalMethod(METHOD, CONFIDENCE),
        attribution_method=attribution.METHOD,
        difference_interval_method=paired.METHOD,
        tail_share=1.0 / ONE_IN,
        other_version=results.other,
        groups=[_group(results, group) for group in results.groups],
        pairs=[_pair(results, *pair) for pair in results.pairs],
    )


def _group(results: Results, group: Group) -> GroupSummary:
    return GroupSummary(
        controller=group.names[CONTROLLER],
        varied=group.varied,
        failed=failed_summary(results, group),
        boundaries=[boundary_summary(results, group, key) for key in results.lines],
        attribution=attribution_summary(results, group) if results.random else None,
        quantities=[_quantity(results, group, quantity) for quantity in results.quantities],
    )


def _quantity(results: Results, group: Group, quantity: Quantity) -> QuantitySummary:
    """Return the distribution of a quantity over the engaged runs, and its worst cases."""
    values = results.columns[quantity.key][group.rows]
    spread = spread_of(values, results.outcomes[group.rows])
    return QuantitySummary(
        name=quantity.key,
        unit=quantity.unit,
        engaged=spread.engaged,
        with_value=spread.with_value,
        quantiles=spread.quantiles,
        cvar_engaged=spread.cvar,
        worst_engaged=case_of(results, group.rows, values, spread.worst_engaged),
        worst=case_of(results, group.rows, values, spread.worst),
    )


def _pair(results: Results, first: Group, second: Group) -> PairSummary:
    """Return the differences of two controllers, first minus second, case by case."""
    outcomes = results.outcomes[first.rows], results.outcomes[second.rows]
    sample = results.is_sample(first)
    differences: list[DifferenceSummary] = []
    for quantity in results.quantities:
        column = results.columns[quantity.key]
        found = paired.difference_of(column[first.rows], column[second.rows], outcomes)
        if not sample:
            found = replace(found, interval=None)
        differences.append(DifferenceSummary(quantity.key, quantity.unit, found))
    return PairSummary(
        first=first.names[CONTROLLER],
        second=second.names[CONTROLLER],
        varied=first.varied,
        outcomes=paired.joint_outcomes(*outcomes),
        no_interval='' if sample else NO_SAMPLE,
        differences=differences,
    )
