# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Summarise the rows of many runs."""

from collections import Counter
from dataclasses import dataclass

import numpy as np
import pyarrow as pa

from ddct_bringup.campaign.keys import SCENARIO
from ddct_bringup.campaign.rows import INDEX, STATE
from ddct_bringup.evaluation import attribution, paired, share
from ddct_bringup.evaluation.boundaries import Boundary, boundary_sides
from ddct_bringup.evaluation.case_figures import CaseFigures
from ddct_bringup.evaluation.dominance import compare, dominators_of
from ddct_bringup.evaluation.grouped_rows import By, Group, GroupedRows
from ddct_bringup.evaluation.held_out_gaps import Gap, gaps_of
from ddct_bringup.evaluation.quantities import MAIN
from ddct_bringup.evaluation.share import Share
from ddct_bringup.evaluation.spread import ONE_IN, QuantitySummary, spread_of
from ddct_bringup.evaluation.summary import (
    GroupSummary,
    Method,
    PairSummary,
    PartSummary,
    Reason,
    Summary,
)
from ddct_bringup.verdict.state import ENGAGED, INVALID, STATES

MOST_REASONS = 5
"""Largest number of reasons for invalid runs in a summary, the most frequent ones."""
NO_SAMPLE = 'the runs are spread over a grid and are no random sample'
METHOD = Method(
    share_interval=share.METHOD,
    difference_interval=paired.METHOD,
    causes=attribution.METHOD,
    confidence=share.CONFIDENCE,
    tail_share=1.0 / ONE_IN,
)


def summarise(table: pa.Table, by: By) -> Summary:
    """
    Return the summary of runs, a row each, in the groups that follow from what was varied.

    The columns are those of a campaign; those of other versions may lack some of the quantities.
    """
    return summary_of(GroupedRows(table, by))


def summary_of(rows: GroupedRows) -> Summary:
    """Return the summary of grouped rows."""
    dominators = _dominators(rows) if rows.by.dominance else {}
    return Summary(
        runs=rows.rows,
        grid=rows.by.grid,
        random=rows.by.random,
        method=METHOD,
        other_version=rows.by.other_version,
        groups=tuple(_group(rows, group, dominators.get(group.label)) for group in rows.groups),
        pairs=tuple(_pair(rows, *pair) for pair in rows.pairs),
    )


def gaps_between(development: pa.Table, held_out: pa.Table) -> tuple[Gap, ...]:
    """
    Return the gap of each of the five figures between two sets of rows of one controller.

    The ranks are those within the scenarios, which a column names where there are several.
    """
    ours, theirs = (_with_scenarios(GroupedRows(table, By())) for table in (development, held_out))
    return gaps_of(ours, theirs)


def _with_scenarios(rows: GroupedRows) -> tuple[CaseFigures, np.ndarray]:
    scenarios = rows.columns.get(SCENARIO, np.full(rows.rows, '')).astype(str)
    return CaseFigures.of(rows.outcomes == ENGAGED, rows.columns), scenarios


def _dominators(rows: GroupedRows) -> dict[str, tuple[str, ...]]:
    """Return by group the controllers that dominate it, where what else varied is the same."""
    found: dict[str, tuple[str, ...]] = {}
    for varied in (group.varied for group in rows.groups):
        alike = [group for group in rows.groups if group.varied == varied]
        if alike[0].label not in found:
            of_controllers = dominators_of(
                {group.controller: rows.case_figures(group) for group in alike}
            )
            found |= {group.label: of_controllers[group.controller] for group in alike}
    return found


@dataclass(frozen=True)
class _Counted:
    """Runs that count, of which shares are."""

    of: int
    in_doubt: int
    """Number of invalid runs besides, which may have any outcome."""
    sample: bool

    @classmethod
    def among(cls, rows: GroupedRows, group: Group) -> '_Counted':
        """Return the runs of a group that count."""
        invalid = int(np.sum(rows.outcomes[group.rows] == INVALID))
        in_doubt = 0 if rows.by.invalid_fails else invalid
        return cls(len(group.rows) - in_doubt, in_doubt, rows.is_sample(group))

    def share(self, count: int) -> Share:
        """Return a number of them as a share, with an interval if they are a random sample."""
        if self.sample:
            return Share.in_sample(count, self.of, self.in_doubt)
        return Share(count, self.of)


def _group(rows: GroupedRows, group: Group, dominated_by: tuple[str, ...] | None) -> GroupSummary:
    outcomes = rows.outcomes[group.rows]
    states = Counter(rows.columns[STATE][group.rows][outcomes != INVALID].tolist())
    in_focus = rows.by.focus is None or group.controller in rows.by.focus
    counted = _Counted.among(rows, group)
    return GroupSummary(
        controller=group.controller,
        varied=group.varied,
        runs=len(group.rows),
        invalid=int(np.sum(outcomes == INVALID)),
        engaged=counted.share(int(np.sum(outcomes == ENGAGED))),
        failed=counted.share(int(np.sum(rows.failed[group.rows]))),
        states={
            str(state): counted.share(states[state])
            for state in dict.fromkeys((*STATES, *states))
            if states[state]
        },
        no_interval='' if counted.sample else NO_SAMPLE,
        reasons=_reasons(rows, group),
        parts=_parts(rows, group, in_focus=in_focus),
        boundaries=tuple(_boundary(rows, group, key) for key in rows.lines),
        causes=_causes(rows, group) if rows.by.random and in_focus else None,
        quantities=_quantities(rows, group),
        dominated_by=dominated_by,
    )


def _reasons(rows: GroupedRows, group: Group) -> tuple[Reason, ...]:
    """Return the reasons for invalid runs: each with the number of runs, and the first of them."""
    places = group.rows[rows.outcomes[group.rows] == INVALID].tolist()
    reasons = [str(rows.columns['reason'][place]) for place in places]
    return tuple(
        Reason(reason, runs, int(rows.columns[INDEX][places[reasons.index(reason)]]))
        for reason, runs in Counter(reasons).most_common(MOST_REASONS)
    )


def _quantities(
    rows: GroupedRows, group: Group, names: tuple[str, ...] = ()
) -> dict[str, QuantitySummary]:
    """Return the distributions of all quantities over the runs of a group, or of those named."""
    outcomes, index, states = (
        column[group.rows] for column in (rows.outcomes, rows.columns[INDEX], rows.columns[STATE])
    )
    return {
        each.key: spread_of(each.unit, rows.columns[each.key][group.rows], outcomes, index, states)
        for each in rows.quantities
        if not names or each.key in names
    }


def _parts(rows: GroupedRows, group: Group, *, in_focus: bool) -> dict[str, PartSummary]:
    """Return the successes, and perhaps the five figures, in each part of a group."""
    if rows.by.parts is None:
        return {}
    found: dict[str, PartSummary] = {}
    for places in rows.alike(group.rows, [rows.by.parts]):
        part = Group(group.names, places)
        engaged = int(np.sum(rows.outcomes[places] == ENGAGED))
        name = str(rows.columns[rows.by.parts][places[0]])
        quantities = _quantities(rows, part, MAIN) if in_focus else {}
        found[name] = PartSummary(_Counted.among(rows, part).share(engaged), quantities)
    return found


def _boundary(rows: GroupedRows, group: Group, key: str) -> Boundary:
    """Return the boundaries on a line over one key, the grid's other numbers at their start."""
    places = rows.others_nominal(group.rows, [key])
    start = rows.start_of(key)
    columns = (rows.columns[name][places] for name in (INDEX, STATE))
    below, above = boundary_sides(
        rows.columns[key][places], rows.outcomes[places], start, *columns
    )
    return Boundary(
        key=key,
        nominal=rows.by.nominal.get(key),
        start=start,
        others={other: rows.start_of(other) for other in rows.others([key])},
        below=below,
        above=above,
    )


def _causes(rows: GroupedRows, group: Group) -> attribution.Causes:
    """Return the numbers that drive failure, and the parts; or why nothing is said of them."""
    places = group.rows
    if not rows.by.invalid_fails:
        places = places[rows.outcomes[places] != INVALID]
    keys = [*rows.numbers, *([rows.by.parts] if rows.by.parts else [])]
    values = {key: rows.columns[key][places] for key in keys}
    return attribution.causes_of(values, rows.failed[places])


def _pair(rows: GroupedRows, first: Group, second: Group) -> PairSummary:
    """Return the differences of two controllers, first minus second, case by case."""
    outcomes = rows.outcomes[first.rows], rows.outcomes[second.rows]
    sample = rows.is_sample(first)
    differences = {
        each.key: paired.difference_of(
            rows.columns[each.key][first.rows],
            rows.columns[each.key][second.rows],
            outcomes,
            sample=sample,
        )
        for each in rows.quantities
    }
    comparison = None
    if rows.by.dominance:
        comparison = compare(rows.case_figures(first), rows.case_figures(second))
    return PairSummary(
        first=first.controller,
        second=second.controller,
        varied=first.varied,
        outcomes=paired.joint_outcomes(*outcomes),
        no_interval='' if sample else NO_SAMPLE,
        differences=differences,
        comparison=comparison,
    )
