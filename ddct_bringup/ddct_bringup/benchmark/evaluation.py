# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Result of one controller on one set of cases: states, quantities, limits, causes of failure."""

from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from ddct_bringup.benchmark.case_rows import CaseRows
from ddct_bringup.benchmark.comparison import non_dominated
from ddct_bringup.benchmark.kept_limits import limits_in
from ddct_bringup.benchmark.outcomes import (
    Columns,
    outcomes_in,
    share_of,
    spread_in,
    successes_in,
)
from ddct_bringup.benchmark.result_types import (
    Causes,
    Evaluation,
    KeyEffect,
    QuantityResult,
    RunShare,
    ScenarioResult,
)
from ddct_bringup.campaign.keys import SCENARIO
from ddct_bringup.campaign_report.evaluated_quantities import QUANTITIES
from ddct_bringup.campaign_report.failure_summary import MOST_REASONS
from ddct_bringup.campaign_report.printed_summary import MAIN
from ddct_bringup.campaign_report.results import is_number
from ddct_bringup.campaign_report.statistics import attribution
from ddct_bringup.campaign_report.summary_types import Reason
from ddct_bringup.campaign_report.texts import where_text
from ddct_bringup.floor.values import METRICS as FLOOR_METRICS
from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.scores.csv_text import OVER_FLOOR
from ddct_bringup.verdict.limits import Limits
from ddct_bringup.verdict.state import INVALID, STATES
from ddct_plant.program.table import Quantity


def states_in(columns: Columns) -> dict[str, RunShare]:
    """Return the share of each state that occurred, those of another version last."""
    valid = outcomes_in(columns) != INVALID
    states = np.where(valid, columns['verdict_state'], INVALID)
    found = Counter(states.tolist())
    return {
        str(state): share_of(found[state], len(states))
        for state in dict.fromkeys((*STATES, *found))
        if found[state]
    }


def scenarios_in(columns: Columns) -> dict[str, ScenarioResult]:
    """Return the successes in each scenario, and the main quantities there."""
    found: dict[str, ScenarioResult] = {}
    names = columns[SCENARIO]
    for name in dict.fromkeys(names.tolist()):
        part = {key: column[names == name] for key, column in columns.items()}
        success = successes_in(part)
        found[str(name)] = {
            'success': share_of(int(success.sum()), len(success)),
            'quantities': quantities_in(part, MAIN),
        }
    return found


def reasons_in(columns: Columns) -> list[Reason]:
    """Return the reasons for invalid runs, the most frequent ones first."""
    places = np.flatnonzero(outcomes_in(columns) == INVALID).tolist()
    reasons = [str(columns['reason'][place]) for place in places]
    return [
        {'reason': reason, 'runs': runs, 'index': places[reasons.index(reason)]}
        for reason, runs in Counter(reasons).most_common(MOST_REASONS)
    ]


def floor_of(quantity: Quantity) -> str | None:
    """Return the name of the floor of a metric or criterion, None for one without floors."""
    metric = METRICS.get(quantity.key)
    names = (metric.criterion, metric.key) if metric else (quantity.key.rpartition('.')[2],)
    return next((name for name in names if name in FLOOR_METRICS), None)


def quantities_in(columns: Columns, names: Sequence[str] = ()) -> list[QuantityResult]:
    """Return the distributions of all quantities or those named, and of their floor ratios."""
    found: list[QuantityResult] = []
    for quantity in QUANTITIES:
        if not is_number(columns.get(quantity.key)) or (names and quantity.key not in names):
            continue
        over = columns.get(f'{OVER_FLOOR}{floor_of(quantity)}')
        found.append(
            {
                'name': quantity.key,
                'unit': quantity.unit,
                **spread_in(columns, columns[quantity.key]),
                'over_floor': None if over is None else spread_in(columns, over),
            }
        )
    return found


def causes_in(columns: Columns, varied: list[str]) -> Causes:
    """
    Return which of the varied keys, and whether the scenario, drive failure.

    A failed run is one that is no success. The scenario counts as a key whose values are names.
    """
    failed = ~successes_in(columns)
    if why := attribution.too_few(failed):
        return {'too_few': why, 'keys': []}
    values = {key: columns[key] for key in (*varied, SCENARIO)}
    several = {key: each for key, each in values.items() if len(set(each.tolist())) > 1}
    effects = attribution.effects_of(several, failed)
    return {'too_few': '', 'keys': [_effect(each) for each in effects]}


def _effect(effect: attribution.Effect) -> KeyEffect:
    part = effect.worst_part
    return {
        'key': effect.key,
        'drives': effect.drives,
        'explained': effect.explained,
        'interval': list(effect.interval),
        'p_value': effect.p_value,
        'worst_part': where_text(part),
        'worst_part_runs': part.runs,
        'worst_part_failed': part.failed,
    }


def evaluations_of(
    rows: CaseRows,
    unavoidable: Mapping[int, list[str]],
    limits: Limits,
    varied: list[str],
    judged: str,
) -> list[Evaluation]:
    """
    Return the evaluation of each controller of some rows, in their order.

    `unavoidable` has the limits that no controller can keep for each case with floors. Only the
    failures of the controller `judged` are attributed to the keys `varied`.
    """
    best = non_dominated(rows)
    found: list[Evaluation] = []
    for name in rows.controllers:
        columns = rows.of(name)
        found.append(
            {
                'controller': name,
                'runs': rows.cases,
                'success': share_of(int(np.sum(successes_in(columns))), rows.cases),
                'states': states_in(columns),
                'scenarios': scenarios_in(columns),
                'reasons': reasons_in(columns),
                'quantities': quantities_in(columns),
                'limits': limits_in(rows, name, unavoidable, limits),
                'causes': causes_in(columns, varied) if name == judged else None,
                'non_dominated': name in best,
            }
        )
    return found
