# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Named distributions have the right quantiles, and stay within the range of their key."""

import re
from typing import Any

import numpy as np
import pytest
from scipy import stats

from ddct_bringup.campaign.distributions import distribution_of
from ddct_bringup.campaign.keys import option_of
from ddct_plant.base.errors import ParameterError

MASS = 'vehicle.mass_kg'
UNIFORM = np.array([1e-9, 0.01, 0.3, 0.5, 0.8, 0.999])


def described(key: str = MASS, **content: Any):
    where = f'random.vary.{key}'
    return distribution_of(where, content, option_of(where, key))


@pytest.mark.parametrize(
    ('content', 'expected'),
    [
        ({'distribution': 'uniform', 'low': 1000, 'high': 1500}, stats.uniform(1000, 500)),
        ({'distribution': 'loguniform', 'low': 10, 'high': 1e3}, stats.loguniform(10, 1e3)),
        (
            {'distribution': 'triangular', 'low': 1, 'mode': 2, 'high': 5},
            stats.triang(0.25, loc=1, scale=4),
        ),
        (
            {'distribution': 'normal', 'mean': 1500, 'std': 200, 'low': 1200, 'high': 2000},
            stats.truncnorm(-1.5, 2.5, loc=1500, scale=200),
        ),
        (
            {'distribution': 'normal', 'mean': 1000, 'std': 100, 'low': 1800, 'high': 1900},
            stats.truncnorm(8, 9, loc=1000, scale=100),
        ),
        ({'distribution': 'lognormal', 'median': 3.0, 'sigma': 0.4}, stats.lognorm(0.4, scale=3)),
    ],
    ids=['uniform', 'loguniform', 'triangular', 'normal', 'normal far out', 'lognormal'],
)
def test_a_quantile_is_that_of_the_distribution_of_the_name(content, expected) -> None:
    found = [described(**content).value(each) for each in UNIFORM]
    assert found == pytest.approx(expected.ppf(UNIFORM), rel=1e-7)


def test_a_choice_takes_each_value_with_its_weight_as_probability() -> None:
    gear = described('gear', distribution='choice', values=[1, 2, 3], weights=[1, 2, 1])
    assert [gear.value(each) for each in (0.01, 0.24, 0.26, 0.74, 0.76, 0.99)] == [
        1,
        1,
        2,
        2,
        3,
        3,
    ]


def test_a_step_rounds_what_is_drawn_to_what_the_key_takes() -> None:
    bounds = {'distribution': 'uniform', 'low': 0.0, 'high': 0.05}
    delay = described('actuator.delay_s', **bounds, step=0.001)
    assert [delay.value(each) for each in (0.0001, 0.7041, 0.9999)] == [0.0, 0.035, 0.05]
    gear = described('gear', distribution='uniform', low=1, high=3, step=1)
    assert [type(gear.value(0.3)), gear.value(0.3), gear.value(0.1)] == [int, 2, 1]


@pytest.mark.parametrize(
    ('key', 'content', 'words'),
    [
        (MASS, {}, 'random.vary.vehicle.mass_kg.distribution is missing: choose from uniform'),
        (MASS, {'distribution': 'gauss'}, "'gauss': choose from uniform"),
        (MASS, {'distribution': 'uniform', 'low': 1}, 'mass_kg.high is missing: uniform needs it'),
        (MASS, {'distribution': 'normal', 'mean': 1, 'std': 0, 'low': 1}, 'std is 0: it must be'),
        (
            MASS,
            {'distribution': 'normal', 'mean': 1500, 'std': 100, 'high': 2000},
            'mass_kg.low is missing: vehicle.mass_kg must be above 0, and normal has no bound',
        ),
        (
            'wear_gain',
            {'distribution': 'lognormal', 'median': 1, 'sigma': 0.2},
            'wear_gain.high is missing: wear_gain must be above 0',
        ),
        (
            MASS,
            {'distribution': 'uniform', 'low': -5, 'high': 5},
            'low is -5 kg: it must be above',
        ),
        (
            'wear_gain',
            {'distribution': 'uniform', 'low': 0.5, 'high': 9},
            'wear_gain.high is 9: it must be at most 3',
        ),
        (MASS, {'distribution': 'uniform', 'low': 5, 'high': 5}, 'must be in this order'),
        (
            MASS,
            {'distribution': 'loguniform', 'low': 0, 'high': 5},
            'low is 0: it must be above 0',
        ),
        (
            MASS,
            {'distribution': 'normal', 'mean': 1, 'std': 1, 'low': 90, 'high': 91},
            'nothing of the distribution is between 90 and 91',
        ),
        (
            MASS,
            {'distribution': 'uniform', 'low': 1, 'hihg': 5},
            'unknown key random.vary.vehicle.mass_kg.hihg: did you mean high?',
        ),
        (
            'gear',
            {'distribution': 'uniform', 'low': 1, 'high': 5},
            'random.vary.gear.step: gear takes whole numbers: give step: 1',
        ),
        (
            'control_start_s',
            {'distribution': 'uniform', 'low': 0.5, 'high': 0.7, 'step': 0.015},
            'low is 0.5: give a multiple of the step, 0.015',
        ),
        (
            'control_start_s',
            {'distribution': 'uniform', 'low': 0.5, 'high': 0.7},
            'control_start_s.step: control_start_s takes multiples of 10 ms: give step: 0.01',
        ),
        (
            'clutch',
            {'distribution': 'uniform', 'low': 0.5, 'high': 0.7},
            'clutch takes no number: use {distribution: choice',
        ),
        ('gear', {'distribution': 'choice', 'values': [1, 9]}, 'gear.values is 9: it must be at'),
        ('gear', {'distribution': 'choice', 'values': []}, 'gear.values: give a list'),
        (
            'gear',
            {'distribution': 'choice', 'values': [1, 2], 'weights': [1]},
            'gear.weights: give a number for each',
        ),
        ('gear', {'distribution': 'choice', 'values': [1], 'weights': [0]}, 'are all zero'),
    ],
)
def test_an_unusable_distribution_is_reported_with_its_key(
    key: str, content: Any, words: str
) -> None:
    with pytest.raises(ParameterError, match=re.escape(words)):
        described(key, **content)


def test_a_distribution_that_is_no_mapping_is_refused() -> None:
    with pytest.raises(ParameterError, match='give {distribution: uniform'):
        distribution_of('random.vary.gear', [1, 2], None)
