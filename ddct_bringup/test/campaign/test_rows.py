# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""One of many runs is scored and judged as the same run alone; a failed one has its reason."""

from pathlib import Path

import pytest
from refusals import refused

from ddct_bringup import api
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.columns import schema_of, shard_bytes
from ddct_bringup.campaign.rows import result_row, scored_headless
from ddct_bringup.campaign.scored import Scorer
from ddct_bringup.campaign.spec import spec_of
from ddct_bringup.run.run_base import RunBase
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.from_python import chosen_from
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.file import ScenarioFile, load_scenario
from ddct_plant.scenario.settings import RunSettings

THESIS = ScenarioFile.read('thesis')
BASE = RunBase(THESIS, {'duration_s': 2.0}, {'clutch': 'stick_slip'}, labels=())


class Diverging(api.Controller):
    """A controller whose command is not a number."""

    def reset(self):
        pass

    def update(self, measurement):
        return api.Command(float('nan'))


def test_varied_values_are_set_as_by_set_with_their_dependent_values():
    settings = BASE.at({'wear_gain': 0.8, 'vehicle.mass_kg': 1800.0})
    scenario = load_scenario(
        'thesis', ['duration_s=2.0', 'vehicle.mass_kg=1800.0'], clutch='stick_slip'
    )
    known = load_scenario('thesis', ['duration_s=2.0'], clutch='stick_slip')
    assert settings == RunSettings(
        scenario, clutch='stick_slip', wear_gain=0.8, known_scenario=known
    )
    inertia = settings.scenario.driveline.vehicle_inertia
    assert inertia == pytest.approx(1800.0 * settings.scenario.vehicle.wheel_radius_m**2)


def test_what_is_varied_replaces_what_all_runs_change():
    settings = BASE.at({'duration_s': 2.5, 'clutch': 'linear'})
    assert (settings.scenario.duration_s, settings.clutch) == (2.5, 'linear')


def test_a_value_that_the_scenario_refuses_is_named():
    with refused(ParameterError, key='vehicle.mass_kg'):
        BASE.at({'vehicle.mass_kg': -1.0})


def test_a_campaign_with_floors_has_a_column_of_each_and_null_where_there_is_none():
    content = {
        'controllers': ['ls8', 'mpc4'],
        'grid': {'wear_gain': [1.0]},
        'floors': ['traction'],
    }
    spec = spec_of(content, Path())
    assert schema_of(spec).names[-1] == 'over_floor.traction'
    plain = spec_of({**content, 'floors': []}, Path())
    assert not any(name.startswith('over_floor') for name in schema_of(plain).names)
    planned = list(Campaign(spec).planned(0, 2))
    rows = [each.row() for each in Scorer(packaged_limits(), floors=spec.floors).scored(planned)]
    ratios = {row['controller']: row['over_floor.traction'] for row in rows}
    assert 1.0 <= ratios['ls8'] < 1.1
    assert ratios['mpc4'] is None
    assert {row['path'] for row in rows} == {'serial'}
    assert shard_bytes(schema_of(spec), rows)


def test_only_the_first_samples_at_each_point_have_floors():
    content = {
        'controllers': ['ls8'],
        'grid': {'wear_gain': [1.0], 'duration_s': [3.0, 2.9]},
        'random': {
            'samples': 2,
            'vary': {'vehicle.mass_kg': {'distribution': 'uniform', 'low': 1400, 'high': 1500}},
        },
        'floors': ['friction_energy'],
        'floor_samples': 1,
    }
    spec = spec_of(content, Path())
    planned = Campaign(spec).planned(0, 4)
    rows = [each.row() for each in Scorer(packaged_limits(), floors=spec.floors).scored(planned)]
    ratios = [row['over_floor.friction_energy'] for row in rows]
    assert [ratio is None for ratio in ratios] == [False, True, False, True]
    assert [row['path'] for row in rows] == ['serial', 'vectorised'] * 2


def test_a_floor_of_an_unknown_metric_is_refused():
    content = {'controllers': ['ls8'], 'grid': {'wear_gain': [1.0]}, 'floors': ['jerk']}
    with refused(ParameterError, key='floors'):
        spec_of(content, Path())


def test_a_run_has_the_metrics_and_the_verdict_of_the_same_run_alone():
    run = scored_headless(BASE.at({'wear_gain': 0.9}), 'ls8', packaged_limits())
    alone = api.run('ls8', duration=2.0, clutch='stick_slip', wear_gain=0.9)
    wall_clock = dict.fromkeys(('update_time_median_us', 'update_time_p99_us'))
    assert run.metrics == {**alone.metrics, **wall_clock}
    assert run.verdict == alone.scores.verdict
    row = result_row(run, {'wear_gain': 0.9})
    assert (row['controller'], row['path'], row['wear_gain']) == ('ls8', 'serial', 0.9)
    assert row['friction_energy_j'] == alone.metrics['friction_energy_j']
    assert (row['valid'], row['verdict_state']) == (True, alone.verdict['state'])
    peak = next(each for each in alone.verdict['criteria'] if each['name'] == 'peak_jerk')
    assert row['criterion.peak_jerk'] == peak['value']


def test_a_failed_run_is_invalid_with_its_reason_and_without_scores():
    chosen = chosen_from(Diverging, 'diverging')
    run = scored_headless(BASE.at({'wear_gain': 0.9}), chosen, packaged_limits())
    row = result_row(run, {'wear_gain': 0.9})
    assert (row['valid'], row['verdict_state']) == (False, 'invalid')
    assert 'diverging' in str(row['reason'])
    assert row['engagement_time_s'] is row['slip_final_rpm'] is None
    sound = scored_headless(BASE.at({}), 'pi', packaged_limits())
    assert row.keys() == result_row(sound, {'wear_gain': 1.0}).keys()
