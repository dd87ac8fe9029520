# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Gaps, dominance, kept limits and distributions of rows that are made by hand."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ddct_bringup.benchmark.case_rows import CaseRows
from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.benchmark.comparison import figures_of, non_dominated, pairs_of
from ddct_bringup.benchmark.evaluation import causes_in, evaluations_of
from ddct_bringup.benchmark.gaps import fisher_p_value, gaps_of
from ddct_bringup.benchmark.report.printed import _p95
from ddct_bringup.benchmark.update_times import read_update_times
from ddct_bringup.campaign.keys import SCENARIO
from ddct_bringup.campaign_report.printed_summary import MAIN
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.base.errors import DdctError

CASES = 6
STATES = 'engaged', 'stalled'


def rows_of(**controllers: dict[str, Any]) -> CaseRows:
    """Return rows of engaged runs with the value 1 everywhere, but for what is given."""
    plain: dict[str, Any] = {
        'valid': True,
        'reason': '',
        'verdict_state': 'engaged',
        'scenario': ['thesis'] * 3 + ['launch'] * 3,
        'wear_gain': np.linspace(0.7, 1.3, CASES),
        **dict.fromkeys(MAIN, 1.0),
        'criterion.weighted_acceleration': 0.3,
        'criterion.judder': 5.0,
        'criterion.traction': 4.0,
        'over_floor.peak_jerk': np.nan,
    }
    names = tuple(controllers)
    columns = {}
    for name in plain:
        given = [controllers[each].get(name, plain[name]) for each in names]
        columns[name] = np.array(
            [np.broadcast_to(np.array(value, dtype=_kind(name)), CASES) for value in given]
        )
    columns['controller'] = np.array([[name] * CASES for name in names], dtype=object)
    return CaseRows(names, columns)


def _kind(name: str) -> Any:
    if name == 'valid':
        return bool
    return object if name in ('reason', 'verdict_state', 'scenario') else float


def test_who_is_worse_in_one_figure_and_better_in_none_is_dominated() -> None:
    rows = rows_of(
        best={},
        jerky={'peak_jerk_m_s3': 2.0},
        quick={'peak_jerk_m_s3': 2.0, 'engagement_time_s': 0.5},
        fails={'engagement_time_s': 0.1, 'verdict_state': ['stalled'] + ['engaged'] * 5},
        never={'verdict_state': 'runaway', 'engagement_time_s': 0.01},
    )
    assert non_dominated(rows) == {'best', 'quick', 'fails'}


def test_to_fail_in_the_hard_cases_is_no_advantage() -> None:
    jerk = [1.0, 2.0, 3.0, 4.0, 9.0, 9.0]
    rows = rows_of(
        honest={'peak_jerk_m_s3': jerk},
        fails={'peak_jerk_m_s3': jerk, 'verdict_state': ['engaged'] * 4 + ['stalled'] * 2},
    )
    assert non_dominated(rows) == {'honest'}
    place = 1 + MAIN.index('peak_jerk_m_s3')
    assert [figures_of(rows, name)[place] for name in rows.controllers] == [4.0, 4.0]
    never = rows_of(never={'verdict_state': 'stalled'})
    assert set(figures_of(never, 'never')[1:]) == {np.inf}


def test_limits_that_nobody_can_keep_are_left_out_and_a_failed_run_keeps_none() -> None:
    rows = rows_of(
        ours={'criterion.judder': [5.0, 7.0, 5.0, 5.0, np.nan, 5.0]},
        other={'verdict_state': ['stalled'] + ['engaged'] * 5},
    )
    unavoidable = {0: ['weighted_acceleration', 'traction'], 1: ['traction'], 4: ['traction']}
    ours, other = evaluations_of(rows, unavoidable, packaged_limits(), ['wear_gain'], 'ours')
    # Case 0: judder. Case 1: both, judder is beyond. Case 4: it is not defined.
    assert (ours['limits']['kept'], ours['limits']['avoidable']) == (3, 4)
    assert ours['limits']['all_kept']['runs'] == 2
    assert (other['limits']['kept'], other['limits']['avoidable']) == (4, 5)
    assert ours['limits']['unavoidable'] == 4


def test_the_limit_of_the_traction_is_kept_or_not_as_those_of_criteria() -> None:
    rows = rows_of(
        ours={'criterion.traction': [6.0, 4.0, 6.0, 4.0, np.nan, 6.0]},
        other={'verdict_state': ['engaged', 'stalled'] + ['engaged'] * 4},
    )
    unavoidable = {case: ['weighted_acceleration', 'judder'] for case in (0, 1, 4)}
    unavoidable[5] = [*unavoidable[0], 'traction']
    ours, other = evaluations_of(rows, unavoidable, packaged_limits(), ['wear_gain'], 'ours')
    # Case 0 is beyond, case 1 within; in case 4 it is not defined, in case 5 nobody could keep it.
    assert (ours['limits']['kept'], ours['limits']['avoidable']) == (1, 2)
    assert (other['limits']['kept'], other['limits']['avoidable']) == (2, 3)
    assert ours['limits']['all_kept']['runs'] == 3


def test_an_invalid_run_is_no_success_and_has_a_state_of_its_own() -> None:
    state = ['invalid', 'nearly_engaged', 'stalled'] + ['engaged'] * 3
    rows = rows_of(ours={'valid': [False] + [True] * 5, 'verdict_state': state, 'reason': 'why'})
    (found,) = evaluations_of(rows, {}, packaged_limits(), ['wear_gain'], 'ours')
    assert (found['success']['runs'], found['success']['share']) == (4, 4 / 6)
    assert {name: each['runs'] for name, each in found['states'].items()} == {
        'engaged': 3,
        'nearly_engaged': 1,
        'stalled': 1,
        'invalid': 1,
    }
    assert [name for name, each in found['scenarios'].items()] == ['thesis', 'launch']
    assert found['scenarios']['thesis']['success']['runs'] == 1
    assert found['reasons'] == [{'reason': 'why', 'runs': 1, 'index': 0}]
    assert found['causes'] is not None
    assert 'too few' in found['causes']['too_few']


def test_scenarios_that_fail_are_named_without_their_neighbours_in_the_specification() -> None:
    scenarios = Cases.packaged().whole.values_of(SCENARIO)
    fails = ('launch', 'launch_hot')
    columns = {
        'scenario': np.repeat(np.array(scenarios, dtype=object), 3),
        'valid': np.ones(3 * len(scenarios), dtype=bool),
        'wear_gain': np.tile([0.8, 1.0, 1.2], len(scenarios)),
    }
    failed = np.isin(columns['scenario'], fails)
    columns['verdict_state'] = np.where(failed, 'stalled', 'engaged').astype(object)
    scenario, wear = causes_in(columns, ['wear_gain'])['keys']
    assert (scenario['key'], scenario['drives']) == ('scenario', True)
    assert scenario['worst_part'] == 'launch, launch_hot'
    assert (scenario['worst_part_failed'], scenario['worst_part_runs']) == (6, 6)
    assert (wear['key'], wear['drives']) == ('wear_gain', False)


def test_the_worst_case_and_the_ratio_to_the_least_are_those_of_engaged_runs() -> None:
    jerk = [9.0, 2.0, 3.0, 4.0, 8.0, 1.0]
    over = [5.0, np.nan, 2.0, np.nan, 3.0, np.nan]
    state = ['runaway'] + ['engaged'] * 5
    rows = rows_of(
        ours={'peak_jerk_m_s3': jerk, 'over_floor.peak_jerk': over, 'verdict_state': state},
        other={},
    )
    found, _ = evaluations_of(rows, {}, packaged_limits(), ['wear_gain'], 'ours')
    (quantity,) = [each for each in found['quantities'] if each['name'] == 'peak_jerk_m_s3']
    assert (quantity['worst'], quantity['p50']) == ({'value': 8.0, 'case': 4}, 3.0)
    assert quantity['over_floor'] is not None
    assert quantity['over_floor']['worst'] == {'value': 3.0, 'case': 4}
    launch = found['scenarios']['launch']['quantities']
    assert [each['worst']['case'] for each in launch if each['name'] == quantity['name']] == [4]
    (pair,) = pairs_of(rows, 'ours')
    assert (pair['both'], pair['second_only']) == (5, 1)


@pytest.mark.parametrize('table', [(8, 0, 0, 8), (5, 3, 2, 6), (40, 0, 38, 2), (3, 0, 3, 0)])
def test_the_exact_test_is_that_of_scipy(table: tuple[int, int, int, int]) -> None:
    from scipy import stats

    expected = stats.fisher_exact([table[:2], table[2:]]).pvalue
    assert fisher_p_value(*table) == pytest.approx(expected, rel=1e-9)


def test_the_test_of_quantities_is_that_of_scipy_and_says_which_set_is_worse() -> None:
    from scipy import stats

    ours = [1.0, 2.0, 2.0, 3.0, 4.0, 5.0]
    theirs = [2.0, 4.0, 6.0, 7.0, 8.0, 9.0]
    gaps = gaps_of(
        rows_of(ours={'peak_jerk_m_s3': ours}).of('ours'),
        rows_of(ours={'peak_jerk_m_s3': theirs}).of('ours'),
    )
    found = {gap['name']: gap for gap in gaps}
    expected = stats.mannwhitneyu(ours, theirs, method='asymptotic')
    assert found['peak_jerk_m_s3']['p_value'] == pytest.approx(expected.pvalue, rel=1e-9)
    larger = 1.0 - expected.statistic / CASES**2
    assert found['peak_jerk_m_s3']['worse'] == pytest.approx(larger)
    assert found['success'] == {'name': 'success', 'p_value': 1.0, 'worse': 0.5, 'differs': False}


def test_a_set_without_an_engaged_run_has_no_gap_of_quantities() -> None:
    some, none = (rows_of(ours={'verdict_state': state}).of('ours') for state in STATES)
    for sets in ((some, none), (none, some)):
        found = {gap['name']: gap for gap in gaps_of(*sets)}
        assert found['peak_jerk_m_s3'] == {
            **{'name': 'peak_jerk_m_s3', 'p_value': None, 'worse': None},
            'differs': False,
        }
        assert found['success']['differs']


def test_each_printed_quantile_is_that_of_its_own_quantity() -> None:
    values = {name: float(place) for place, name in enumerate(MAIN, 2)}
    (found,) = evaluations_of(
        rows_of(ours={**values, 'over_floor.peak_jerk': 1.5}),
        *({}, packaged_limits(), ['wear_gain'], 'ours'),
    )
    printed = {name: _p95(found, name) for name in MAIN}
    assert {name: float(value) for name, (value, _) in printed.items()} == values
    assert [name for name, (_, ratio) in printed.items() if ratio == '1.50'] == ['peak_jerk_m_s3']
    assert _p95({**found, 'quantities': []}, MAIN[0]) == ('-', '-')


def test_an_honest_controller_is_rarely_marked() -> None:
    draw = np.random.default_rng(3)
    marked = 0
    for _ in range(200):
        sets = [
            rows_of(
                ours={name: draw.lognormal(size=CASES) for name in MAIN}
                | {'verdict_state': draw.choice(['engaged', 'stalled'], CASES, p=[0.8, 0.2])}
            ).of('ours')
            for _ in range(2)
        ]
        marked += any(gap['differs'] for gap in gaps_of(*sets))
    assert marked <= 10  # 5 % of 200


@pytest.mark.parametrize('text', ['{}', '[1]', '{"controllers": {"ls8": 2.0}}'])
def test_damaged_update_times_are_refused(text: str, tmp_path: Path) -> None:
    (tmp_path / 'timing.json').write_text(text, encoding='utf-8')
    with pytest.raises(DdctError, match='measures them again'):
        read_update_times(tmp_path)
