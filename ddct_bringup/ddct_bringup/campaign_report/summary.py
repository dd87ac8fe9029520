# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Build the summary of a campaign: the content of `summary.json`."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from ddct_bringup.campaign.columns import CONTROLLER
from ddct_bringup.campaign_report import attribution, paired
from ddct_bringup.campaign_report.boundaries import boundaries
from ddct_bringup.campaign_report.outcome import (
    CONFIDENCE,
    FAILED,
    METHOD,
    Share,
    count_outcomes,
)
from ddct_bringup.campaign_report.results import Group, Results
from ddct_bringup.campaign_report.spread import ONE_IN, spread_of
from ddct_bringup.verdict.state import INVALID, STATES
from ddct_plant.program.table import Quantity

Summary = dict[str, Any]
"""Content of `summary.json` or a part of it; the page on campaigns describes its keys."""
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
            name: list(value) if isinstance(value, tuple) else value
            for name, value in asdict(results.other).items()
        },
        'groups': [_group(results, group) for group in results.groups],
        'pairs': [_pair(results, *pair) for pair in results.pairs],
    }


def _group(results: Results, group: Group) -> Summary:
    return {
        'controller': group.names[CONTROLLER],
        'varied': group.varied,
        'failed': _failed(results, group),
        'boundaries': [_boundary(results, group, key) for key in results.lines],
        'attribution': _attribution(results, group) if results.random else None,
        'quantities': [_quantity(results, group, quantity) for quantity in results.quantities],
    }


def _failed(results: Results, group: Group) -> Summary:
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


def _states(results: Results, group: Group, invalid: int, *, sample: bool) -> Summary:
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


def _share(share: Share, *, sample: bool) -> Summary:
    return {'share': share.share, 'interval': list(share.interval()) if sample else None}


def _reasons(results: Results, group: Group) -> list[Summary]:
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


def _boundary(results: Results, group: Group, key: str) -> Summary:
    """Return the boundaries on a line over one key, the grid's other numbers at their start."""
    rows = results.others_nominal(group.rows, [key])
    start = results.start_of(key)
    sides = boundaries(results.columns[key][rows], results.outcomes[rows], start)
    return {
        'key': key,
        'nominal': results.nominal.get(key),
        'start': start,
        'others': {other: results.start_of(other) for other in results.others([key])},
        **{
            name: {
                'last_good': side.last_good_value,
                'first_failure': side.first_failure,
                'failed': side.failed,
                'runs': side.runs,
                'invalid': side.invalid,
                **_run(results, rows, side.row),
            }
            for name, side in sides.items()
        },
    }


def _attribution(results: Results, group: Group) -> Summary:
    """Return the keys that drive failure, or why there is no attribution."""
    rows = group.rows[results.outcomes[group.rows] != INVALID]
    failed = results.outcomes[rows] == FAILED
    values = {key: results.columns[key][rows] for key in results.numbers}
    varied = {key: each for key, each in values.items() if len(np.unique(each)) > 1}
    found: Summary = {'runs': len(rows), 'failed': int(np.sum(failed))}
    why = attribution.too_few(failed)
    effects = [] if why else attribution.effects_of(varied, failed)
    return {
        **found,
        'too_few': why,
        'keys': [
            {
                'key': each.key,
                'drives': each.drives,
                'explained': each.explained,
                'interval': list(each.interval),
                'p_value': each.p_value,
                'worst_part': asdict(each.worst_part),
            }
            for each in effects
        ],
    }


def _quantity(results: Results, group: Group, quantity: Quantity) -> Summary:
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


def _pair(results: Results, first: Group, second: Group) -> Summary:
    """Return the differences of two controllers, first minus second, case by case."""
    outcomes = results.outcomes[first.rows], results.outcomes[second.rows]
    sample = results.is_sample(first)
    differences = []
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
        **asdict(paired.joint_outcomes(*outcomes)),
        'no_interval': '' if sample else NO_SAMPLE,
        'differences': differences,
    }


def _case(
    results: Results, rows: np.ndarray, values: np.ndarray, place: int | None
) -> Mapping[str, Any]:
    value = None if place is None else float(values[place])
    return {'value': value, **_run(results, rows, place)}


def _run(results: Results, rows: np.ndarray, place: int | None) -> Mapping[str, Any]:
    """Return index and state of a run."""
    if place is None:
        return {'index': None, 'state': None}
    row = rows[place]
    return {
        'index': int(results.columns['index'][row]),
        'state': str(results.columns['verdict_state'][row]),
    }
