# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every mistake in a specification of a tuning names its key."""

from pathlib import Path
from typing import Any

import pytest
from refusals import refused

from ddct_bringup.tuning.specification.other_car import in_car
from ddct_bringup.tuning.specification.packaged_specs import packaged_specs
from ddct_bringup.tuning.specification.parameters import Parameter
from ddct_bringup.tuning.specification.spec import read_tuning_spec, tuning_spec_of
from ddct_controllers.registry import controller_spec
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.option import Option

GAIN = {'low': 0.1, 'high': 1.0}
GOOD: dict[str, Any] = {
    'parameters': {'proportional_gain': GAIN},
    'objectives': {'engagement_time_s': {}},
    'constraints': {'engaged': {'at_least': 0.9}},
    'campaign': {'grid': {'wear_gain': [0.7, 1.0]}},
}


@pytest.mark.parametrize(
    ('key', 'value', 'named'),
    [
        ('parameters', {'gain': GAIN}, 'parameters.gain'),
        ('parameters', {}, 'parameters'),
        ('parameters', {'proportional_gain': {'low': 1.0}}, 'parameters.proportional_gain.high'),
        (
            'parameters',
            {'proportional_gain': {'low': 1.0, 'high': 1.0}},
            'parameters.proportional_gain',
        ),
        (
            'parameters',
            {'proportional_gain': {'low': -1.0, 'high': 1.0}},
            'parameters.proportional_gain.low',
        ),
        (
            'parameters',
            {'proportional_gain': {'low': 0.0, 'high': 1.0, 'scale': 'log'}},
            'parameters.proportional_gain.low',
        ),
        (
            'parameters',
            {'proportional_gain': {**GAIN, 'scale': 'cubic'}},
            'parameters.proportional_gain.scale',
        ),
        ('objectives', {'lock_time': {}}, 'objectives.lock_time'),
        (
            'objectives',
            {'peak_jerk_m_s3': {'statistic': 'p99'}},
            'objectives.peak_jerk_m_s3.statistic',
        ),
        (
            'objectives',
            {'peak_jerk_m_s3': {'direction': 'down'}},
            'objectives.peak_jerk_m_s3.direction',
        ),
        ('objectives', {'update_time_over_pi': {}}, 'objectives.update_time_over_pi'),
        ('objectives', {'peak_jerk_over_least': {}}, 'objectives.peak_jerk_over_least'),
        ('constraints', {}, 'constraints.engaged'),
        ('constraints', {'engaged': {}}, 'constraints.engaged'),
        ('constraints', {'engaged': {'at_least': 1, 'at_most': 1}}, 'constraints.engaged'),
        (
            'constraints',
            {'engaged': {'at_least': 1, 'statistic': 'mean'}},
            'constraints.engaged.statistic',
        ),
        ('campaign', {'controllers': ['pi']}, 'campaign.controllers'),
        ('campaign', {'benchmark': ['lunch']}, 'campaign.benchmark.lunch'),
        ('campaign', {'benchmark': 'some'}, 'campaign.benchmark'),
        ('campaign', {'benchmark': 'all', 'samples': 99}, 'campaign.samples'),
        ('trials', 0, 'trials'),
        ('seed', -1, 'seed'),
        ('seed', 2**31, 'seed'),
        ('trial', 5, 'trial'),
    ],
)
def test_a_mistake_names_its_key(key: str, value: object, named: str) -> None:
    with refused(ParameterError, key=named):
        tuning_spec_of({**GOOD, key: value}, Path.cwd(), controller_spec('pi'))


def test_the_largest_seed_of_a_search_is_that_of_a_campaign() -> None:
    spec = tuning_spec_of({**GOOD, 'seed': 2**31 - 1}, Path.cwd(), controller_spec('pi'))
    assert spec.seed == 2**31 - 1


def test_a_mistake_in_a_file_names_its_line(tmp_path: Path) -> None:
    path = tmp_path / 'spec.yaml'
    path.write_text('trials: 5\nparameters:\n  gain: {low: 0, high: 1}\n')
    with refused(ParameterError, key='objectives', place='spec.yaml'):
        read_tuning_spec(str(path), controller_spec('pi'))
    path.write_text(
        'objectives: {engaged: }\ncampaign: {grid: {wear_gain: [1.0]}}\n'
        'parameters:\n  gain: {low: 0, high: 1}\n'
    )
    with refused(ParameterError, key='parameters.gain', place='spec.yaml: line 4'):
        read_tuning_spec(str(path), controller_spec('pi'))


def test_a_controller_without_options_is_refused() -> None:
    with refused(ParameterError, key='parameters'):
        tuning_spec_of(GOOD, Path.cwd(), controller_spec('hinf_sampled'))


def test_what_is_no_number_is_refused() -> None:
    parameters = {'backend': GAIN}
    with refused(ParameterError, key='parameters.backend'):
        tuning_spec_of({**GOOD, 'parameters': parameters}, Path.cwd(), controller_spec('mpc3'))


@pytest.mark.parametrize('name', packaged_specs())
def test_packaged_specifications_can_run(name: str) -> None:
    controller = 'mpc3' if name.startswith('mpc') else 'pi'
    spec = read_tuning_spec(name, controller_spec(controller))
    assert spec.development.campaign(controller, spec.folder).runs > 1


def test_values_are_short_and_within_the_range() -> None:
    whole = Parameter('n', 3, 9, 'linear', Option(4, 'steps'))
    assert whole.rounded(5) == 5 and isinstance(whole.rounded(5), int)
    real = Parameter('x', 0.12345678, 1.0, 'log', Option(0.5, 'gain'))
    assert real.rounded(0.98765432) == 0.987654
    assert real.rounded(0.12345679) == 0.123457
    assert Parameter('x', 0.12345678, 1, 'log', Option(0.5, '')).rounded(0.1234561) == 0.12345678
    time = Parameter('t', 0.0, 1.0, 'linear', Option(0.1, 'time', 's', whole_periods=True))
    assert time.rounded(0.4567) == 0.46


def test_a_car_takes_the_place_of_that_of_the_cases_which_are_drawn_around_its_values(
    tmp_path: Path,
) -> None:
    (tmp_path / 'mine.yaml').write_text('base: city7\nvehicle: {mass_kg: 900}\n')
    of_pi, car = controller_spec('pi'), str(tmp_path / 'mine.yaml')
    spec, left_out = in_car(read_tuning_spec('pi_launches', of_pi), car, of_pi)
    campaign = spec.development.campaign('pi', spec.folder)
    assert campaign.spec.vary['vehicle.mass_kg'].ends == (720.0, 1170.0)
    assert not left_out
    settings = campaign.run(0).settings
    assert settings.known.scenario.vehicle.mass_kg == 900.0
    for cases in ({'benchmark': 'all'}, {'grid': {'scenario': ['launch', 'tip_in']}}):
        given = tuning_spec_of({**GOOD, 'campaign': cases}, tmp_path, of_pi)
        changed, left_out = in_car(given, car, of_pi)
        assert 'tip_in' in left_out
        names = changed.development.campaign('pi', tmp_path).spec.grid['scenario']
        assert 'launch' in names
        assert 'tip_in' not in names
    with pytest.raises(ParameterError, match='has a car already'):
        in_car(changed, car, of_pi)
