# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Share of failed engagements: counts by the states of runs, and their interval."""

import numpy as np
import pytest
from made_results import made_results

from ddct_bringup.evaluation.share import Share, outcomes_of
from ddct_bringup.evaluation.summarise import summary_of
from ddct_bringup.verdict.state import ENGAGED, INVALID, STATES
from ddct_plant.files.json_records import to_json


def test_every_state_but_engaged_and_invalid_is_a_failed_engagement():
    outcomes = outcomes_of(np.ones(len(STATES), dtype=bool), np.array(STATES))
    wanted = [state if state in (ENGAGED, INVALID) else 'failed' for state in STATES]
    assert outcomes.tolist() == wanted
    assert wanted.count('failed') == len(STATES) - 2


def test_failures_of_one_state_have_a_share_and_an_interval_of_their_own():
    from scipy.stats import binomtest

    states = [ENGAGED, 'late', 'late', 'not_engaged']
    results = made_results(states, {'wear_gain': [0.7, 0.8, 0.9, 1.0]}, random=['wear_gain'])
    (group,) = summary_of(results).groups
    assert (group.engaged.count, group.failed.count, group.failed.of) == (1, 3, 4)
    late = group.states['late']
    assert (late.count, late.value) == (2, 0.5)
    exact = binomtest(2, 4).proportion_ci(method='exact')
    assert (late.low, late.high) == pytest.approx((exact.low, exact.high), rel=1e-9)


def test_a_state_of_another_version_is_a_failure_and_is_named():
    results = made_results([ENGAGED, 'crumbled'], {'wear_gain': [0.7, 1.0]})
    (group,) = summary_of(results).groups
    assert group.failed.count == 1
    assert group.states['crumbled'].count == 1


def test_a_run_that_does_not_count_is_invalid_whatever_state_it_has():
    assert outcomes_of(np.array([False]), np.array([ENGAGED])).tolist() == [INVALID]


@pytest.mark.parametrize(
    ('failed', 'runs'), [(0, 1), (1, 1), (0, 50), (3, 50), (49, 50), (50, 50), (7, 100000)]
)
def test_the_interval_is_that_of_scipy(failed, runs):
    from scipy.stats import binomtest

    exact = binomtest(failed, runs).proportion_ci(confidence_level=0.95, method='exact')
    found = Share.in_sample(failed, runs)
    assert (found.low, found.high) == pytest.approx(
        (exact.low, exact.high), abs=4e-12
    )  # scipy searches: xtol 2e-12


def test_none_of_n_failed_leaves_up_to_the_closed_form():
    assert Share.in_sample(0, 60).high == pytest.approx(1.0 - 0.025 ** (1 / 60), rel=1e-12)


def test_invalid_runs_are_in_no_share_and_widen_the_interval_to_both_sides():
    from scipy.stats import binomtest

    states = [ENGAGED] * 6 + ['late'] * 2 + [INVALID] * 2
    results = made_results(states, {'wear_gain': [*range(10)]}, random=['wear_gain'])
    (group,) = summary_of(results).groups
    assert (group.runs, group.engaged.count, group.invalid) == (10, 6, 2)
    assert (group.failed.count, group.failed.of, group.failed.value) == (2, 8, 2 / 8)
    lowest = binomtest(2, 10).proportion_ci(method='exact').low
    highest = binomtest(4, 10).proportion_ci(method='exact').high
    found = group.failed.low, group.failed.high
    assert found == pytest.approx((lowest, highest), rel=1e-9)


def test_of_invalid_runs_alone_there_is_no_share():
    assert Share.in_sample(0, 0, in_doubt=3) == Share(0, 0, 0.0, 1.0)
    assert Share(0, 0).value is None
    assert Share.in_sample(0, 0) == Share(0, 0)


def test_a_share_and_its_interval_have_one_text_each_with_dashes_for_what_is_not_there():
    found = Share(1, 8, 0.003, 0.527)
    assert (found.text, found.interval_text) == ('12.5 %', '0.3 to 52.7 %')
    assert (Share(0, 0).text, Share(1, 8).interval_text) == ('-', '-')


def test_runs_on_a_grid_have_a_share_but_no_interval_with_a_reason():
    (group,) = summary_of(made_results([ENGAGED, 'withheld'], {'wear_gain': [1.0, 1.2]})).groups
    assert group.failed == Share(1, 2, None, None)
    assert 'no random sample' in group.no_interval


def test_random_runs_at_one_point_of_a_grid_have_an_interval_and_at_two_have_none():
    varied = {'gear': [1.0] * 4, 'wear_gain': [0.7, 0.8, 0.9, 1.0]}
    states = ['stalled', ENGAGED, ENGAGED, ENGAGED]
    one = summary_of(made_results(states, varied, random=['wear_gain']))
    assert one.groups[0].failed.low is not None
    varied['gear'] = [1.0, 1.0, 2.0, 2.0]
    two = summary_of(made_results(states, varied, random=['wear_gain']))
    assert two.groups[0].failed.low is None


def test_a_varied_text_key_makes_separate_groups():
    results = made_results(
        [ENGAGED, 'stalled', 'withheld', ENGAGED],
        {'clutch': ['linear', 'stick_slip'] * 2, 'wear_gain': [1.0] * 4},
        controllers=['pi', 'pi', 'ls8', 'ls8'],
    )
    groups = to_json(summary_of(results))['groups']
    assert [(each['controller'], each['varied']['clutch']) for each in groups] == [
        ('pi', 'linear'),
        ('pi', 'stick_slip'),
        ('ls8', 'linear'),
        ('ls8', 'stick_slip'),
    ]
    assert [each['failed']['count'] for each in groups] == [0, 1, 1, 0]
    assert groups[1]['states'] == {'stalled': {'count': 1, 'of': 1, 'low': None, 'high': None}}


def test_reasons_of_invalid_runs_are_listed_the_most_frequent_first():
    results = made_results([INVALID, ENGAGED, INVALID, INVALID], {'wear_gain': [1.0] * 4})
    results.columns['reason'][:] = ['once', '', 'twice', 'twice']
    assert to_json(summary_of(results))['groups'][0]['reasons'] == [
        {'reason': 'twice', 'runs': 2, 'index': 2},
        {'reason': 'once', 'runs': 1, 'index': 0},
    ]
