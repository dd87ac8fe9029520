"""Put the summary of a campaign together: the content of `summary.json`."""

from collections import Counter
from collections.abc import Mapping
from typing import Any

import numpy as np

from ddct_bringup.campaign.columns import CONTROLLER
from ddct_bringup.campaign_report.outcome import (
    CONFIDENCE,
    METHOD,
    ONE_IN,
    failed_share,
    tail_of,
    ways_out,
)
from ddct_bringup.campaign_report.results import Group, Results
from ddct_bringup.verdict.state import INVALID, STATES
from ddct_plant.program.table import Figure

Summary = dict[str, Any]
"""As the page on campaigns describes it."""
SCHEMA_VERSION = 1
"""Of `summary.json`."""
MOST_REASONS = 5
"""That are given of why runs are invalid, the most frequent ones."""
NO_SAMPLE = 'the runs are spread over a grid and are no random sample'


def summary_of(results: Results) -> Summary:
    """Return what came out of a campaign."""
    return {
        'schema_version': SCHEMA_VERSION,
        'runs': results.rows,
        'grid': list(results.grid),
        'random': list(results.random),
        'interval': {'method': METHOD, 'confidence': CONFIDENCE},
        'tail_share': 1.0 / ONE_IN,
        'groups': [_group(results, group) for group in results.groups],
    }


def _group(results: Results, group: Group) -> Summary:
    return {
        'controller': group.names[CONTROLLER],
        'varied': {key: name for key, name in group.names.items() if key != CONTROLLER},
        'failed': _failed(results, group),
        'first_failures': [_first_failure(results, group, key) for key in results.numbers],
        'quantities': [_quantity(results, group, figure) for figure in results.quantities],
    }


def _failed(results: Results, group: Group) -> Summary:
    counts = failed_share(results.outcomes[group.rows])
    sample = results.is_sample(group)
    states = results.columns['verdict_state'][group.rows]
    return {
        'runs': counts.runs,
        'engaged': counts.engaged,
        'failed': counts.failed,
        'invalid': counts.invalid,
        'share': counts.share,
        'interval': list(counts.interval()) if sample else None,
        'no_interval': '' if sample else NO_SAMPLE,
        'states': {state: int(np.sum(states == state)) for state in STATES if state in states},
        'reasons': _reasons(results, group),
    }


def _reasons(results: Results, group: Group) -> list[Summary]:
    """Return why runs are invalid: each reason with how many runs, and the first of them."""
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


def _first_failure(results: Results, group: Group, key: str) -> Summary:
    """Return the ways out of one varied number, the grid's other numbers being at their start."""
    rows = results.others_nominal(group.rows, [key])
    start = results.start_of(key)
    ways = ways_out(results.columns[key][rows], results.outcomes[rows], start)
    return {
        'key': key,
        'nominal': results.nominal.get(key),
        'start': start,
        'others': {other: results.start_of(other) for other in results.others([key])},
        **{
            side: {
                'held_to': way.held_to,
                'first_failure': way.first_failure,
                'lost': way.lost,
                'runs': way.runs,
                **_run(results, rows, way.row),
            }
            for side, way in ways.items()
        },
    }


def _quantity(results: Results, group: Group, figure: Figure) -> Summary:
    """Return how bad a quantity becomes."""
    values = results.columns[figure.key][group.rows]
    tail = tail_of(values, results.outcomes[group.rows])
    return {
        'name': figure.key,
        'unit': figure.unit,
        'with_value': tail.with_value,
        'median': tail.median,
        'cvar': tail.cvar,
        'tail_runs': tail.runs,
        'lacking': tail.lacking,
        'worst_engaged': _case(results, group.rows, values, tail.worst_engaged),
        'worst': _case(results, group.rows, values, tail.worst),
    }


def _case(
    results: Results, rows: np.ndarray, values: np.ndarray, place: int | None
) -> Mapping[str, Any]:
    value = None if place is None else float(values[place])
    return {'value': value, **_run(results, rows, place)}


def _run(results: Results, rows: np.ndarray, place: int | None) -> Mapping[str, Any]:
    """Return which run it is and what it came to."""
    if place is None:
        return {'index': None, 'state': None}
    row = rows[place]
    return {
        'index': int(results.columns['index'][row]),
        'state': str(results.columns['verdict_state'][row]),
    }
