# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""States, figures, gaps and dominance of rows that are made by hand."""

from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest

from ddct_bringup.benchmark.case_rows import CaseRows
from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.benchmark.report.judged_sections import spread_cells
from ddct_bringup.benchmark.report.texts import dominance_lines
from ddct_bringup.benchmark.update_times import read_update_times
from ddct_bringup.campaign.keys import SCENARIO
from ddct_bringup.evaluation.quantities import MAIN
from ddct_bringup.evaluation.spread import RunValue
from ddct_bringup.evaluation.summarise import gaps_between, summarise
from ddct_bringup.evaluation.summary import Reason, Summary
from ddct_bringup.metrics.catalogue import FIGURES
from ddct_plant.base.errors import DdctError

CASES = 6
STATES = 'engaged', 'stalled'


def rows_of(cases: int = CASES, **controllers: dict[str, Any]) -> CaseRows:
    """Return rows of engaged runs with the value 1 everywhere, but for what is given."""
    plain: dict[str, Any] = {
        'valid': True,
        'reason': '',
        'state': 'engaged',
        'scenario': ['thesis'] * (cases // 2) + ['launch'] * (cases - cases // 2),
        'wear_gain': np.linspace(0.7, 1.3, cases),
        **{each.key: 1.0 for each in FIGURES},
    }
    columns = {}
    for name in plain:
        given = [each.get(name, plain[name]) for each in controllers.values()]
        columns[name] = np.concatenate(
            [np.broadcast_to(np.array(value, dtype=_kind(name)), cases) for value in given]
        ).tolist()
    columns['controller'] = [name for name in controllers for _ in range(cases)]
    return CaseRows(pa.table(columns))


def _kind(name: str) -> Any:
    if name == 'valid':
        return bool
    return object if name in ('reason', 'state', 'scenario') else float


def summary_of(rows: CaseRows, focus: str = 'ours', *, dominance: bool = True) -> Summary:
    """Return the summary of rows, with what is wanted of one controller."""
    return summarise(rows.table, rows.by(['wear_gain'], (focus,), dominance=dominance))


def test_engaged_is_the_only_success_and_an_invalid_run_has_a_state_of_its_own() -> None:
    state = ['invalid', 'late', 'stalled'] + ['engaged'] * 3
    rows = rows_of(ours={'valid': [False] + [True] * 5, 'state': state, 'reason': 'why'})
    (found,) = summary_of(rows).groups
    assert (found.engaged.count, found.engaged.of, found.failed.count) == (3, 6, 3)
    assert {name: (each.count, each.of) for name, each in found.states.items()} == {
        'engaged': (3, 6),
        'late': (1, 6),
        'stalled': (1, 6),
    }
    assert found.invalid == 1
    assert [*found.parts] == ['thesis', 'launch']
    assert found.parts['thesis'].engaged.count == 0
    assert found.reasons == (Reason('why', 1, 0),)
    assert found.causes is not None
    assert 'too few' in found.causes.too_few


def test_the_response_is_the_time_to_the_lock_and_the_late_torque() -> None:
    times = {'time_to_final_lock_s': [1.0] * 5 + [2.0], 'torque_late_s': [0.1] * 5 + [0.5]}
    (found,) = summary_of(rows_of(ours=times)).groups
    response = found.quantities['response_s']
    assert (response.quantiles.p50, response.worst_engaged) == (1.1, RunValue(2.5, 5, 'engaged'))


def test_a_figure_that_a_launch_cannot_have_is_left_out() -> None:
    """The torque dip of a shift is one; it was counted as infinite in every launch."""
    dip = [np.nan] * 3 + [10.0, 20.0, 30.0]
    rows = rows_of(ours={'torque_dip_percent': dip}, other={})
    summary = summary_of(rows)
    found = summary.group('ours').quantities['torque_dip_percent']
    assert (found.with_value, found.quantiles.p50) == (3, 20.0)
    (pair,) = summary.pairs
    assert pair.comparison is not None
    assert [*pair.comparison.figures] == list(MAIN)


def test_scenarios_that_fail_are_named_without_their_neighbours_in_the_specification() -> None:
    scenarios = Cases.packaged().whole.values_of(SCENARIO)
    fails = ('launch', 'launch_hot')
    named = np.repeat(np.array(scenarios, dtype=object), 3)
    columns = {
        'scenario': named,
        'wear_gain': np.tile([0.8, 1.0, 1.2], len(scenarios)),
        'state': np.where(np.isin(named, fails), 'stalled', 'engaged').astype(object),
    }
    causes = summary_of(rows_of(len(named), ours=columns)).group('ours').causes
    assert causes is not None
    scenario, wear = causes.keys
    assert (scenario.key, scenario.drives) == ('scenario', True)
    assert scenario.worst_part.names == fails
    assert (scenario.worst_part.failed.count, scenario.worst_part.failed.of) == (6, 6)
    assert (wear.key, wear.drives) == ('wear_gain', False)


def test_the_worst_case_is_that_of_the_successes() -> None:
    jerk = [9.0, 2.0, 3.0, 4.0, 8.0, 1.0]
    state = ['not_engaged'] + ['engaged'] * 5
    rows = rows_of(ours={'peak_jerk_m_s3': jerk, 'state': state}, other={})
    summary = summary_of(rows)
    found, other = summary.groups
    quantity = found.quantities['peak_jerk_m_s3']
    worst = RunValue(8.0, 4, 'engaged')
    assert (quantity.worst_engaged, quantity.quantiles.p50) == (worst, 3.0)
    launch = found.parts['launch'].quantities
    assert launch['peak_jerk_m_s3'].worst_engaged == worst
    assert {*launch} == {*MAIN}
    assert (other.parts['launch'].quantities, other.causes) == ({}, None)
    (pair,) = summary.pairs
    assert (pair.outcomes.both, pair.outcomes.second_only) == (5, 1)
    response = pair.differences['response_s']
    assert (response.cases, response.quantiles.p50) == (5, 0.0)


def test_the_dominance_names_its_cases_and_those_left_out() -> None:
    """Four of forty cases have no demand, so that no controller has a response there."""
    late = [np.nan] * 4 + [1.0] * 36
    rows = rows_of(
        40,
        ours={'torque_late_s': late},
        jerky={'torque_late_s': late, 'peak_jerk_m_s3': 2.0},
        quick={'torque_late_s': 0.5, 'peak_jerk_m_s3': 2.0},
    )
    summary = summary_of(rows)
    assert {each.controller: each.dominated_by for each in summary.groups} == {
        'ours': (),
        'jerky': ('ours', 'quick'),
        'quick': (),
    }
    jerky, quick = summary.pairs
    assert (jerky.second, quick.second) == ('jerky', 'quick')
    assert jerky.comparison is not None
    response, jerk, *_ = jerky.comparison.figures.values()
    assert (response.left_out, response.better, response.worse) == (4, 0, 0)
    assert (jerk.left_out, jerk.better, jerk.median_difference) == (0, 40, -1.0)
    assert list(dominance_lines(summary, 'ours')) == [
        'no controller dominates ours: 40 cases, left out at most: response 4, peak jerk 0, '
        'friction work 0, weighted A_x 0, releases 0',
        'ours dominates jerky: 40 cases, left out: response 4, peak jerk 0, friction work 0, '
        'weighted A_x 0, releases 0',
    ]
    assert list(dominance_lines(summary_of(rows, dominance=False), 'ours')) == []  # a quick one


def test_a_controller_that_fails_is_dominated_by_one_that_does_not() -> None:
    rows = rows_of(40, fails={'state': 'stalled', 'peak_jerk_m_s3': 0.1}, other={})
    summary = summary_of(rows, 'fails')
    assert [each.dominated_by for each in summary.groups] == [('other',), ()]
    (pair,) = summary.pairs
    assert pair.comparison is not None
    figures = pair.comparison.figures.values()
    assert [(each.median_difference, each.worse_in_median) for each in figures] == [
        (None, True)
    ] * 5


def test_the_gaps_are_those_of_ranks_within_scenarios_with_failures_as_worst() -> None:
    """The launch is the better scenario, and there are more of its runs in held-out cases."""
    levels = {'thesis': 100.0, 'launch': 1.0}
    sets = []
    for scenarios, added in ((['thesis'] * 5 + ['launch'], 0.0), (['thesis'] + ['launch'] * 5, 1)):
        jerk = [levels[name] + added + place / 10 for place, name in enumerate(scenarios)]
        rows = rows_of(ours={'scenario': scenarios, 'peak_jerk_m_s3': jerk})
        sets.append(rows.table)
    found = {gap.name: gap for gap in gaps_between(*sets)}
    assert list(found) == list(MAIN)
    assert found['peak_jerk_m_s3'].worse == 1.0
    assert found['releases'].worse == 0.5
    without = [each.drop_columns([SCENARIO]) for each in sets]
    jerk_gap = gaps_between(*without)[MAIN.index('peak_jerk_m_s3')]
    assert jerk_gap.worse is not None
    assert jerk_gap.worse < 0.5


@pytest.mark.parametrize('place', [0, 1])
def test_failures_in_one_set_are_a_gap_only_if_they_are_held_out(place: int) -> None:
    sets = [rows_of(20, ours={'state': state}).table for state in STATES]
    found = gaps_between(sets[place], sets[1 - place])
    assert [gap.differs for gap in found] == [place == 0] * 5
    assert [gap.left_out for gap in found] == [0] * 5


def test_each_printed_quantile_is_that_of_its_own_quantity() -> None:
    values = {name: float(place) for place, name in enumerate(MAIN, 2) if name != 'response_s'}
    rows = rows_of(ours=values)
    (found,) = summary_of(rows).groups
    shown: dict[str, Any] = {name: spread_cells(found.quantities, name) for name in MAIN}
    expected = {**values, 'response_s': 2.0}
    assert {name: float(cells[1].text) for name, cells in shown.items()} == expected
    assert {cells[-1] for cells in shown.values()} == {0}
    assert spread_cells({}, MAIN[0]) == (0, None, None, None, None)


@pytest.mark.parametrize('text', ['{}', '[1]', '{"controllers": {"ls8": 2.0}}'])
def test_damaged_update_times_are_refused(text: str, tmp_path: Path) -> None:
    (tmp_path / 'timing.json').write_text(text, encoding='utf-8')
    with pytest.raises(DdctError, match='measures the update times again'):
        read_update_times(tmp_path)
