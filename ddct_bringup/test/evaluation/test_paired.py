# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Differences of two controllers, case by case, where both engaged."""

import numpy as np
import pytest
from made_results import made_results

from ddct_bringup.evaluation.paired import difference_of, median_interval
from ddct_bringup.evaluation.summarise import summary_of
from ddct_bringup.verdict.state import ENGAGED
from ddct_plant.files.json_records import to_json

JERK = 'peak_jerk_m_s3'


def test_only_cases_in_which_both_engaged_are_compared_and_the_others_are_counted():
    results = made_results(
        [ENGAGED, ENGAGED, 'stalled', 'stalled', ENGAGED, 'withheld', ENGAGED, 'stalled'],
        {'wear_gain': [0.7, 0.8, 0.9, 1.0] * 2},
        {JERK: [5.0, 6.0, 90.0, 80.0, 4.0, 70.0, 1.0, 60.0]},
        controllers=['pi'] * 4 + ['ls8'] * 4,
        random=['wear_gain'],
    )
    (pair,) = to_json(summary_of(results))['pairs']
    assert (pair['first'], pair['second'], pair['varied']) == ('pi', 'ls8', {})
    counts = [pair[name] for name in ('cases', 'both', 'first_only', 'second_only', 'neither')]
    assert counts == [4, 1, 1, 1, 1]
    found = pair['differences'][JERK]
    assert (found['cases'], found['p50'], found['interval']) == (1, 1.0, None)


def test_cases_are_joined_by_their_number_whatever_varies_between_the_groups():
    clutch = ['linear', 'stick_slip'] * 3
    results = made_results(
        [ENGAGED] * 12,
        {'clutch': clutch * 2, 'wear_gain': [0.7, 0.7, 0.8, 0.8, 0.9, 0.9] * 2},
        {JERK: [1.0, 10.0, 2.0, 20.0, 3.0, 30.0, 11.0, 10.5, 12.0, 20.5, 13.0, 30.5]},
        controllers=['pi'] * 6 + ['ls8'] * 6,
    )
    linear, sticking = to_json(summary_of(results))['pairs']
    assert linear['varied'] == {'clutch': 'linear'}
    assert [linear['differences'][JERK][name] for name in ('p5', 'p50', 'p95')] == [-10.0] * 3
    assert [sticking['differences'][JERK][name] for name in ('p5', 'p50', 'p95')] == [-0.5] * 3


def test_of_a_signed_quantity_magnitudes_are_compared():
    outcomes = np.array([ENGAGED] * 2, dtype=object)
    found = difference_of(np.array([-7.0, 2.0]), np.array([5.0, -1.0]), (outcomes, outcomes))
    assert found.quantiles.p50 == 1.5


def test_a_case_without_a_value_is_left_out():
    outcomes = np.array([ENGAGED] * 3, dtype=object)
    found = difference_of(
        np.array([1.0, np.nan, 3.0]), np.array([1.0, 1.0, np.nan]), (outcomes, outcomes)
    )
    assert found.cases == 1


@pytest.mark.parametrize('runs', [6, 7, 19, 40, 133])
def test_the_interval_of_the_median_is_that_of_scipy(runs):
    from scipy.stats import quantile_test

    values = np.random.default_rng(runs).normal(size=runs)
    exact = quantile_test(values, p=0.5).confidence_interval(0.95)
    assert median_interval(values) == (exact.low, exact.high)


@pytest.mark.parametrize('runs', [0, 1, 5])
def test_fewer_than_six_cases_have_no_interval(runs):
    assert median_interval(np.arange(float(runs))) is None


def test_points_of_a_grid_have_no_interval():
    runs = 10
    varied = {'wear_gain': np.linspace(0.7, 1.0, runs).tolist() * 2}
    results = made_results(
        [ENGAGED] * 2 * runs,
        varied,
        {JERK: np.arange(2.0 * runs).tolist()},
        controllers=['pi'] * runs + ['ls8'] * runs,
    )
    (pair,) = to_json(summary_of(results))['pairs']
    assert pair['differences'][JERK]['interval'] is None
    assert 'no random sample' in pair['no_interval']
    sampled = made_results(
        [ENGAGED] * 2 * runs,
        varied,
        {JERK: np.arange(2.0 * runs).tolist()},
        controllers=['pi'] * runs + ['ls8'] * runs,
        random=['wear_gain'],
    )
    (pair,) = to_json(summary_of(sampled))['pairs']
    assert pair['differences'][JERK]['interval'] == [-10.0, -10.0]
