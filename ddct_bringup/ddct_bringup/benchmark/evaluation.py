# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Result of one controller on one set of cases: states, quantities, causes of failure."""

from collections import Counter
from collections.abc import Sequence

import numpy as np

from ddct_bringup.benchmark.case_rows import CaseRows
from ddct_bringup.benchmark.evaluated import EVALUATED, MAIN, Columns, values_of
from ddct_bringup.benchmark.outcomes import (
    outcomes_in,
    share_of,
    share_of_successes,
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
from ddct_bringup.campaign.rows import STATE
from ddct_bringup.campaign_report.failure_summary import MOST_REASONS
from ddct_bringup.campaign_report.statistics import attribution
from ddct_bringup.campaign_report.summary_types import Reason
from ddct_bringup.campaign_report.texts import where_text
from ddct_bringup.verdict.state import INVALID, STATES


def states_in(columns: Columns) -> dict[str, RunShare]:
    """Return the share of each state that occurred, those of another version last."""
    valid = outcomes_in(columns) != INVALID
    states = np.where(valid, columns[STATE], INVALID)
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
        found[str(name)] = ScenarioResult(
            success=share_of_successes(part),
            quantities=quantities_in(part, MAIN),
        )
    return found


def reasons_in(columns: Columns) -> list[Reason]:
    """Return the reasons for invalid runs, the most frequent ones first."""
    places = np.flatnonzero(outcomes_in(columns) == INVALID).tolist()
    reasons = [str(columns['reason'][place]) for place in places]
    return [
        Reason(reason, runs, places[reasons.index(reason)])
        for reason, runs in Counter(reasons).most_common(MOST_REASONS)
    ]


def quantities_in(columns: Columns, names: Sequence[str] = ()) -> list[QuantityResult]:
    """Return the distributions of all quantities, or of those named."""
    found: list[QuantityResult] = []
    for key in names or EVALUATED:
        values = values_of(columns, key)
        if values is not None:
            spread = spread_in(columns, values)
            found.append(QuantityResult(key, EVALUATED[key].unit, spread))
    return found


def causes_in(columns: Columns, varied: list[str]) -> Causes:
    """
    Return which of the varied keys, and whether the scenario, drive failure.

    A failed run is one that is no success. The scenario counts as a key whose values are names.
    """
    failed = ~successes_in(columns)
    if why := attribution.too_few(failed):
        return Causes(too_few=why, keys=[])
    values = {key: columns[key] for key in (*varied, SCENARIO)}
    several = {key: each for key, each in values.items() if len(set(each.tolist())) > 1}
    effects = attribution.effects_of(several, failed)
    return Causes(too_few='', keys=[_effect(each) for each in effects])


def _effect(effect: attribution.Effect) -> KeyEffect:
    part = effect.worst_part
    return KeyEffect(
        key=effect.key,
        drives=effect.drives,
        explained=effect.explained,
        interval=effect.interval,
        p_value=effect.p_value,
        worst_part=where_text(part),
        worst_part_runs=part.runs,
        worst_part_failed=part.failed,
    )


def evaluations_of(rows: CaseRows, varied: list[str], judged: str) -> list[Evaluation]:
    """
    Return the evaluation of each controller of some rows, in their order.

    Only the failures of the controller `judged` are attributed to the keys `varied`.
    """
    found: list[Evaluation] = []
    for name in rows.controllers:
        columns = rows.of(name)
        found.append(
            Evaluation(
                controller=name,
                runs=rows.cases,
                success=share_of_successes(columns),
                states=states_in(columns),
                scenarios=scenarios_in(columns),
                reasons=reasons_in(columns),
                quantities=quantities_in(columns),
                causes=causes_in(columns, varied) if name == judged else None,
            )
        )
    return found
