# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Named distributions have the right quantiles, and stay within the range of their key."""

from typing import Any

import numpy as np
import pytest
from made_later import later
from refusals import refused

from ddct_bringup.campaign.keys import option_of
from ddct_bringup.campaign.specification.distribution import distribution_of
from ddct_plant.base.errors import ParameterError

MASS = 'vehicle.mass_kg'
UNIFORM = np.array([1e-9, 0.01, 0.3, 0.5, 0.8, 0.999])


def described(key: str = MASS, **content: Any):
    where = f'random.vary.{key}'
    return distribution_of(where, content, option_of(where, key))


@pytest.mark.parametrize(
    ('content', 'expected'),
    [
        (
            {'distribution': 'uniform', 'low': 1000, 'high': 1500},
            later('scipy.stats.uniform', 1000, 500),
        ),
        (
            {'distribution': 'loguniform', 'low': 10, 'high': 1e3},
            later('scipy.stats.loguniform', 10, 1e3),
        ),
        (
            {'distribution': 'triangular', 'low': 1, 'mode': 2, 'high': 5},
            later('scipy.stats.triang', 0.25, loc=1, scale=4),
        ),
        (
            {'distribution': 'normal', 'mean': 1500, 'std': 200, 'low': 1200, 'high': 2000},
            later('scipy.stats.truncnorm', -1.5, 2.5, loc=1500, scale=200),
        ),
        (
            {'distribution': 'normal', 'mean': 1000, 'std': 100, 'low': 1800, 'high': 1900},
            later('scipy.stats.truncnorm', 8, 9, loc=1000, scale=100),
        ),
        (
            {'distribution': 'lognormal', 'median': 3.0, 'sigma': 0.4},
            later('scipy.stats.lognorm', 0.4, scale=3),
        ),
    ],
    ids=['uniform', 'loguniform', 'triangular', 'normal', 'normal far out', 'lognormal'],
)
def test_a_quantile_is_that_of_the_distribution_of_the_name(content, expected) -> None:
    found = [described(**content).value(each) for each in UNIFORM]
    assert found == pytest.approx(expected().ppf(UNIFORM), rel=1e-7)


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
    ('key', 'content', 'wrong'),
    [
        (MASS, {}, 'random.vary.vehicle.mass_kg.distribution'),
        (MASS, {'distribution': 'gauss'}, 'random.vary.vehicle.mass_kg.distribution'),
        (MASS, {'distribution': 'uniform', 'low': 1}, 'random.vary.vehicle.mass_kg.high'),
        (
            MASS,
            {'distribution': 'normal', 'mean': 1, 'std': 0, 'low': 1},
            'random.vary.vehicle.mass_kg.std',
        ),
        (
            MASS,
            {'distribution': 'normal', 'mean': 1500, 'std': 100, 'high': 2000},
            'random.vary.vehicle.mass_kg.low',
        ),
        (
            'wear_gain',
            {'distribution': 'lognormal', 'median': 1, 'sigma': 0.2},
            'random.vary.wear_gain.high',
        ),
        (
            MASS,
            {'distribution': 'uniform', 'low': -5, 'high': 5},
            'random.vary.vehicle.mass_kg.low',
        ),
        (
            'wear_gain',
            {'distribution': 'uniform', 'low': 0.5, 'high': 9},
            'random.vary.wear_gain.high',
        ),
        (MASS, {'distribution': 'uniform', 'low': 5, 'high': 5}, 'random.vary.vehicle.mass_kg'),
        (
            MASS,
            {'distribution': 'loguniform', 'low': 0, 'high': 5},
            'random.vary.vehicle.mass_kg.low',
        ),
        (
            MASS,
            {'distribution': 'normal', 'mean': 1, 'std': 1, 'low': 90, 'high': 91},
            'random.vary.vehicle.mass_kg',
        ),
        (
            MASS,
            {'distribution': 'uniform', 'low': 1, 'hihg': 5},
            'random.vary.vehicle.mass_kg.hihg',
        ),
        (
            'gear',
            {'distribution': 'uniform', 'low': 1, 'high': 5},
            'random.vary.gear.step',
        ),
        (
            'control_start_s',
            {'distribution': 'uniform', 'low': 0.5, 'high': 0.7, 'step': 0.015},
            'random.vary.control_start_s.low',
        ),
        (
            'control_start_s',
            {'distribution': 'uniform', 'low': 0.5, 'high': 0.7},
            'random.vary.control_start_s.step',
        ),
        (
            'clutch',
            {'distribution': 'uniform', 'low': 0.5, 'high': 0.7},
            'random.vary.clutch',
        ),
        ('gear', {'distribution': 'choice', 'values': [1, 0]}, 'random.vary.gear.values'),
        ('gear', {'distribution': 'choice', 'values': []}, 'random.vary.gear.values'),
        (
            'gear',
            {'distribution': 'choice', 'values': [1, 2], 'weights': [1]},
            'random.vary.gear.weights',
        ),
        (
            'gear',
            {'distribution': 'choice', 'values': [1], 'weights': [0]},
            'random.vary.gear.weights',
        ),
    ],
)
def test_an_unusable_distribution_is_reported_with_its_key(
    key: str, content: Any, wrong: str
) -> None:
    with refused(ParameterError, wrong):
        described(key, **content)


def test_a_distribution_that_is_no_mapping_is_refused() -> None:
    with refused(ParameterError, 'random.vary.gear'):
        distribution_of('random.vary.gear', [1, 2], None)
