# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Build the summary of a campaign: the content of `summary.json`."""

from collections import Counter

import numpy as np

from ddct_bringup.campaign.columns import CONTROLLER
from ddct_bringup.campaign_report import attribution, paired
from ddct_bringup.campaign_report.boundaries import FailureBoundary, boundaries
from ddct_bringup.campaign_report.outcome import (
    CONFIDENCE,
    FAILED,
    METHOD,
    Share,
    count_outcomes,
)
from ddct_bringup.campaign_report.results import Group, Results
from ddct_bringup.campaign_report.spread import ONE_IN, spread_of
from ddct_bringup.campaign_report.summary_types import (
    AttributionSummary,
    BoundarySide,
    BoundarySummary,
    Case,
    DifferenceSummary,
    FailedSummary,
    GroupSummary,
    PairSummary,
    PartSummary,
    QuantitySummary,
    Reason,
    RunOfCase,
    ShareOfRuns,
    StateSummary,
    Summary,
)
from ddct_bringup.verdict.state import INVALID, STATES
from ddct_plant.program.table import Quantity

SCHEMA_VERSION = 2
"""Schema version of `summary.json`."""
MOST_REASONS = 5
"""Largest number of reasons for invalid runs in a summary, the most frequent ones."""
NO_SAMPLE = 'the runs are spread over a grid and are no random sample'


def summary_of(results: Results) -> Summary:
    """Return the summary of the results of a campaign."""
    return {
        'schema_version': SCHEMA_VERSION,
        'runs': results.rows,
        'grid': list(results.grid),
        'random': list(results.random),
        'interval': {'method': METHOD, 'confidence': CONFIDENCE},
        'attribution_method': attribution.METHOD,
        'difference_interval_method': paired.METHOD,
        'tail_share': 1.0 / ONE_IN,
        'other_version': {
            'absent': list(results.other.absent),
            'unknown': list(results.other.unknown),
            'no_nominal': results.other.no_nominal,
        },
        'groups': [_group(results, group) for group in results.groups],
        'pairs': [_pair(results, *pair) for pair in results.pairs],
    }


def _group(results: Results, group: Group) -> GroupSummary:
    return {
        'controller': group.names[CONTROLLER],
        'varied': group.varied,
        'failed': _failed(results, group),
        'boundaries': [_boundary(results, group, key) for key in results.lines],
        'attribution': _attribution(results, group) if results.random else None,
        'quantities': [_quantity(results, group, quantity) for quantity in results.quantities],
    }


def _failed(results: Results, group: Group) -> FailedSummary:
    counts = count_outcomes(results.outcomes[group.rows])
    sample = results.is_sample(group)
    return {
        'runs': counts.runs,
        'engaged': counts.engaged,
        'failed': counts.failed,
        'invalid': counts.invalid,
        **_share(counts.failed_share, sample=sample),
        'no_interval': '' if sample else NO_SAMPLE,
        'states': _states(results, group, counts.invalid, sample=sample),
        'reasons': _reasons(results, group),
    }


def _states(
    results: Results, group: Group, invalid: int, *, sample: bool
) -> dict[str, StateSummary]:
    """Return the number of valid runs in each state, those of another version last."""
    valid = group.rows[results.outcomes[group.rows] != INVALID]
    found = Counter(results.columns['verdict_state'][valid].tolist())
    return {
        str(state): {
            'runs': found[state],
            **_share(Share(found[state], invalid, len(group.rows)), sample=sample),
        }
        for state in dict.fromkeys((*STATES, *found))
        if found[state]
    }


def _share(share: Share, *, sample: bool) -> ShareOfRuns:
    return {'share': share.share, 'interval': list(share.interval()) if sample else None}


def _reasons(results: Results, group: Group) -> list[Reason]:
    """Return the reasons for invalid runs: each with the number of runs, and the first of them."""
    rows = [row for row in group.rows.tolist() if results.outcomes[row] == INVALID]
    reasons = [str(results.columns['reason'][row]) for row in rows]
    return [
        {
            'reason': reason,
            'runs': runs,
            'index': int(results.columns['index'][rows[reasons.index(reason)]]),
        }
        for reason, runs in Counter(reasons).most_common(MOST_REASONS)
    ]


def _boundary(results: Results, group: Group, key: str) -> BoundarySummary:
    """Return the boundaries on a line over one key, the grid's other numbers at their start."""
    rows = results.others_nominal(group.rows, [key])
    start = results.start_of(key)
    sides = boundaries(results.columns[key][rows], results.outcomes[rows], start)
    return {
        'key': key,
        'nominal': results.nominal.get(key),
        'start': start,
        'others': {other: results.start_of(other) for other in results.others([key])},
        'below': _side(results, rows, sides['below']),
        'above': _side(results, rows, sides['above']),
    }


def _side(results: Results, rows: np.ndarray, side: FailureBoundary) -> BoundarySide:
    return {
        'last_good': side.last_good_value,
        'first_failure': side.first_failure,
        'failed': side.failed,
        'runs': side.runs,
        'invalid': side.invalid,
        **_run(results, rows, side.row),
    }


def _attribution(results: Results, group: Group) -> AttributionSummary:
    """Return the keys that drive failure, or why there is no attribution."""
    rows = group.rows[results.outcomes[group.rows] != INVALID]
    failed = results.outcomes[rows] == FAILED
    values = {key: results.columns[key][rows] for key in results.numbers}
    varied = {key: each for key, each in values.items() if len(np.unique(each)) > 1}
    why = attribution.too_few(failed)
    effects = [] if why else attribution.effects_of(varied, failed)
    return {
        'runs': len(rows),
        'failed': int(np.sum(failed)),
        'too_few': why,
        'keys': [
            {
                'key': each.key,
                'drives': each.drives,
                'explained': each.explained,
                'interval': list(each.interval),
                'p_value': each.p_value,
                'worst_part': _part(each.worst_part),
            }
            for each in effects
        ],
    }


def _part(part: attribution.Part) -> PartSummary:
    return {'low': part.low, 'high': part.high, 'runs': part.runs, 'failed': part.failed}


def _quantity(results: Results, group: Group, quantity: Quantity) -> QuantitySummary:
    """Return the distribution of a quantity over the engaged runs, and its worst cases."""
    values = results.columns[quantity.key][group.rows]
    spread = spread_of(values, results.outcomes[group.rows])
    return {
        'name': quantity.key,
        'unit': quantity.unit,
        'engaged': spread.engaged,
        'with_value': spread.with_value,
        **spread.quantiles,
        'cvar_engaged': spread.cvar,
        'worst_engaged': _case(results, group.rows, values, spread.worst_engaged),
        'worst': _case(results, group.rows, values, spread.worst),
    }


def _pair(results: Results, first: Group, second: Group) -> PairSummary:
    """Return the differences of two controllers, first minus second, case by case."""
    outcomes = results.outcomes[first.rows], results.outcomes[second.rows]
    joint = paired.joint_outcomes(*outcomes)
    sample = results.is_sample(first)
    differences: list[DifferenceSummary] = []
    for quantity in results.quantities:
        column = results.columns[quantity.key]
        found = paired.difference_of(column[first.rows], column[second.rows], outcomes)
        differences.append(
            {
                'name': quantity.key,
                'unit': quantity.unit,
                'cases': found.cases,
                **found.quantiles,
                'interval': list(found.interval) if found.interval and sample else None,
            }
        )
    return {
        'first': first.names[CONTROLLER],
        'second': second.names[CONTROLLER],
        'varied': first.varied,
        'cases': joint.cases,
        'both': joint.both,
        'first_only': joint.first_only,
        'second_only': joint.second_only,
        'neither': joint.neither,
        'no_interval': '' if sample else NO_SAMPLE,
        'differences': differences,
    }


def _case(results: Results, rows: np.ndarray, values: np.ndarray, place: int | None) -> Case:
    value = None if place is None else float(values[place])
    return {'value': value, **_run(results, rows, place)}


def _run(results: Results, rows: np.ndarray, place: int | None) -> RunOfCase:
    """Return index and state of a run."""
    if place is None:
        return {'index': None, 'state': None}
    row = rows[place]
    return {
        'index': int(results.columns['index'][row]),
        'state': str(results.columns['verdict_state'][row]),
    }
