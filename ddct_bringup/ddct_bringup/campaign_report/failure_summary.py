# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Part of the summary of a campaign: how often, where and by which keys engagements fail."""

from collections import Counter

import numpy as np

from ddct_bringup.campaign.rows import STATE
from ddct_bringup.campaign_report.results import Group, Results
from ddct_bringup.campaign_report.statistics import attribution
from ddct_bringup.campaign_report.statistics.boundaries import FailureBoundary, boundaries
from ddct_bringup.campaign_report.statistics.outcome import FAILED, Share, count_outcomes
from ddct_bringup.campaign_report.statistics.parts import Part, RangePart
from ddct_bringup.campaign_report.summary_types import (
    AttributionSummary,
    BoundarySide,
    BoundarySummary,
    EffectSummary,
    FailedSummary,
    PartSummary,
    Reason,
    RunValue,
    StateSummary,
)
from ddct_bringup.verdict.state import INVALID, STATES

MOST_REASONS = 5
"""Largest number of reasons for invalid runs in a summary, the most frequent ones."""
NO_SAMPLE = 'the runs are spread over a grid and are no random sample'


def failed_summary(results: Results, group: Group) -> FailedSummary:
    """Return the numbers of runs of a group by outcome, with states and reasons."""
    counts = count_outcomes(results.outcomes[group.rows])
    sample = results.is_sample(group)
    return FailedSummary(
        runs=counts.runs,
        engaged=counts.engaged,
        failed=counts.failed,
        invalid=counts.invalid,
        share=counts.failed_share.share,
        interval=_interval(counts.failed_share, sample=sample),
        no_interval='' if sample else NO_SAMPLE,
        states=_states(results, group, counts.invalid, sample=sample),
        reasons=_reasons(results, group),
    )


def _states(
    results: Results, group: Group, invalid: int, *, sample: bool
) -> dict[str, StateSummary]:
    """Return the number of valid runs in each state, those of another version last."""
    valid = group.rows[results.outcomes[group.rows] != INVALID]
    found = Counter(results.columns[STATE][valid].tolist())
    shares = {
        str(state): Share(found[state], invalid, len(group.rows))
        for state in dict.fromkeys((*STATES, *found))
        if found[state]
    }
    return {
        state: StateSummary(each.count, each.share, _interval(each, sample=sample))
        for state, each in shares.items()
    }


def _interval(share: Share, *, sample: bool) -> tuple[float, float] | None:
    return share.interval() if sample else None


def _reasons(results: Results, group: Group) -> list[Reason]:
    """Return the reasons for invalid runs: each with the number of runs, and the first of them."""
    rows = [row for row in group.rows.tolist() if results.outcomes[row] == INVALID]
    reasons = [str(results.columns['reason'][row]) for row in rows]
    return [
        Reason(
            reason=reason,
            runs=runs,
            index=int(results.columns['index'][rows[reasons.index(reason)]]),
        )
        for reason, runs in Counter(reasons).most_common(MOST_REASONS)
    ]


def boundary_summary(results: Results, group: Group, key: str) -> BoundarySummary:
    """Return the boundaries on a line over one key, the grid's other numbers at their start."""
    rows = results.others_nominal(group.rows, [key])
    start = results.start_of(key)
    sides = boundaries(results.columns[key][rows], results.outcomes[rows], start)
    return BoundarySummary(
        key=key,
        nominal=results.nominal.get(key),
        start=start,
        others={other: results.start_of(other) for other in results.others([key])},
        below=_side(results, rows, sides['below']),
        above=_side(results, rows, sides['above']),
    )


def _side(results: Results, rows: np.ndarray, side: FailureBoundary) -> BoundarySide:
    index, state = _reference(results, rows, side.row)
    return BoundarySide(
        last_good=side.last_good_value,
        first_failure=side.first_failure,
        failed=side.failed,
        runs=side.runs,
        invalid=side.invalid,
        index=index,
        state=state,
    )


def attribution_summary(results: Results, group: Group) -> AttributionSummary:
    """Return the keys that drive failure, or why there is no attribution."""
    rows = group.rows[results.outcomes[group.rows] != INVALID]
    failed = results.outcomes[rows] == FAILED
    values = {key: results.columns[key][rows] for key in results.numbers}
    varied = {key: each for key, each in values.items() if len(np.unique(each)) > 1}
    why = attribution.too_few(failed)
    effects = [] if why else attribution.effects_of(varied, failed)
    return AttributionSummary(
        runs=len(rows),
        failed=int(np.sum(failed)),
        too_few=why,
        keys=[
            EffectSummary(
                key=each.key,
                drives=each.drives,
                explained=each.explained,
                interval=each.interval,
                p_value=each.p_value,
                worst_part=_part(each.worst_part),
            )
            for each in effects
        ],
    )


def _part(part: Part) -> PartSummary:
    assert isinstance(part, RangePart)  # the keys are numbers: each name has a group of its own
    return PartSummary(part.low, part.high, part.runs, part.failed)


def case_of(results: Results, rows: np.ndarray, values: np.ndarray, place: int | None) -> RunValue:
    """Return the value, index and state of the run at a place among `rows`, None for none."""
    value = None if place is None else float(values[place])
    return RunValue(value, *_reference(results, rows, place))


def _reference(
    results: Results, rows: np.ndarray, place: int | None
) -> tuple[int | None, str | None]:
    """Return index and state of the run at a place among `rows`, None for none."""
    if place is None:
        return None, None
    row = rows[place]
    return int(results.columns['index'][row]), str(results.columns[STATE][row])
