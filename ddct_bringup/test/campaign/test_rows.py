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
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

BASE = RunBase(ScenarioFile.read('thesis_sticking'), {'duration_s': 2.0}, {}, labels=())


class Diverging(api.Controller):
    """A controller whose command is not a number."""

    def reset(self):
        pass

    def update(self, measurement):
        return api.Command(float('nan'))


def test_varied_values_are_set_as_by_set_with_their_dependent_values():
    settings = BASE.at({'wear_gain': 0.8, 'vehicle.mass_kg': 1800.0})
    scenario = load_scenario('thesis_sticking', ['duration_s=2.0', 'vehicle.mass_kg=1800.0'])
    known = load_scenario('thesis_sticking', ['duration_s=2.0'])
    assert settings == RunSettings(
        KnownSettings(known), CaseSettings(wear_gain=0.8, scenario=scenario)
    )
    inertia = settings.scenario.driveline.vehicle_inertia
    assert inertia == pytest.approx(1800.0 * settings.scenario.vehicle.wheel_radius_m**2)


def test_what_is_varied_replaces_what_all_runs_change():
    settings = BASE.at({'duration_s': 2.5, 'clutch': 'linear'})
    assert (settings.scenario.duration_s, settings.known.clutch) == (2.5, 'linear')


def test_a_value_that_the_scenario_refuses_is_named():
    with refused(ParameterError, key='vehicle.mass_kg'):
        BASE.at({'vehicle.mass_kg': -1.0})


def rows_of(spec):
    """Return the rows of all runs of a specification."""
    campaign = Campaign(spec)
    scorer = Scorer(packaged_limits(), floors=spec.floors)
    return [each.row() for each in scorer.scored(campaign.planned(0, campaign.runs))]


def test_a_campaign_with_floors_has_the_peak_jerk_over_the_least_and_whether_that_is_a_bound():
    content = {'controllers': ['ls8', 'mpc4'], 'grid': {'wear_gain': [1.0]}}
    spec = spec_of({**content, 'floors': True}, Path())
    ls8, mpc4 = rows = rows_of(spec)
    assert ls8['peak_jerk_over_least'] > 1.0
    assert mpc4['peak_jerk_over_least'] is not None
    assert (ls8['least_is_bound'], mpc4['least_is_bound']) == (True, False)
    assert {row['path'] for row in rows} == {'serial'}
    assert shard_bytes(schema_of(spec), rows)
    plain = spec_of({**content, 'floors': False}, Path())
    assert schema_of(plain) == schema_of(spec)
    for row in rows_of(plain):
        assert (row['peak_jerk_over_least'], row['least_is_bound']) == (None, None)


def test_only_the_first_samples_at_each_point_have_floors():
    content = {
        'controllers': ['ls8'],
        'grid': {'wear_gain': [1.0], 'duration_s': [3.0, 2.9]},
        'random': {
            'samples': 2,
            'vary': {'vehicle.mass_kg': {'distribution': 'uniform', 'low': 1400, 'high': 1500}},
        },
        'floors': True,
        'floor_samples': 1,
    }
    rows = rows_of(spec_of(content, Path()))
    ratios = [row['peak_jerk_over_least'] for row in rows]
    assert [ratio is None for ratio in ratios] == [False, True, False, True]
    assert [row['path'] for row in rows] == ['serial', 'vectorised'] * 2


@pytest.mark.parametrize('floors', [['peak_jerk'], 'usual', 1, None])
def test_floors_that_are_neither_true_nor_false_are_refused(floors):
    content = {'controllers': ['ls8'], 'grid': {'wear_gain': [1.0]}, 'floors': floors}
    with refused(ParameterError, key='floors'):
        spec_of(content, Path())


def test_a_run_has_the_metrics_and_the_state_of_the_same_run_alone():
    run = scored_headless(BASE.at({'wear_gain': 0.9}), 'ls8', packaged_limits())
    alone = api.run('ls8', duration=2.0, scenario='thesis_sticking', wear_gain=0.9)
    wall_clock = dict.fromkeys(('update_time_median_us', 'update_time_p99_us'))
    assert run.metrics == {**alone.metrics, **wall_clock}
    assert (run.state, run.why, run.limits) == (alone.state, alone.why, alone.limits)
    row = result_row(run, {'wear_gain': 0.9})
    assert (row['controller'], row['path'], row['wear_gain']) == ('ls8', 'serial', 0.9)
    assert row['friction_work_j'] == alone.figures['friction_work_j']
    assert (row['valid'], row['state'], row['why']) == (True, alone.state, alone.why)


def test_a_failed_run_is_invalid_with_its_reason_and_without_scores():
    chosen = chosen_from(Diverging, 'diverging')
    run = scored_headless(BASE.at({'wear_gain': 0.9}), chosen, packaged_limits())
    row = result_row(run, {'wear_gain': 0.9})
    assert (row['valid'], row['state']) == (False, 'invalid')
    assert 'diverging' in str(row['reason'])
    assert row['engagement_time_s'] is row['slip_final_rpm'] is None
    sound = scored_headless(BASE.at({}), 'pi', packaged_limits())
    assert row.keys() == result_row(sound, {'wear_gain': 1.0}).keys()
