# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""One of many runs is scored and judged as the same run alone; a failed one has its reason."""

import pytest
from refusals import refused

from ddct_bringup import api
from ddct_bringup.campaign.columns import runs_table, schema_over
from ddct_bringup.campaign.rows import SERIAL, ScoredRow, scored_headless
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


def row_of(run):
    """Return the row of a run over the wear gain."""
    row = ScoredRow(0, run.controller, 0, {'wear_gain': 0.9}, run, SERIAL)
    (found,) = runs_table(schema_over({'wear_gain': [0.9]}), [row]).to_pylist()
    return found


def test_a_run_has_the_metrics_and_the_state_of_the_same_run_alone():
    run = scored_headless(BASE.at({'wear_gain': 0.9}), 'ls8', packaged_limits())
    alone = api.run('ls8', duration=2.0, scenario='thesis_sticking', wear_gain=0.9)
    wall_clock = dict.fromkeys(('update_time_median_us', 'update_time_p99_us'))
    assert run.metrics == {**alone.metrics, **wall_clock}
    assert (run.state, run.why, run.limits) == (alone.state, alone.why, alone.limits)
    row = row_of(run)
    assert (row['controller'], row['path'], row['wear_gain']) == ('ls8', 'serial', 0.9)
    assert row['friction_work_j'] == alone.figures['friction_work_j']
    assert (row['valid'], row['state'], row['why']) == (True, alone.state, alone.why)
    assert row.keys().isdisjoint({'peak_jerk_over_least', 'least_is_bound'})


def test_a_failed_run_is_invalid_with_its_reason_and_without_scores():
    chosen = chosen_from(Diverging, 'diverging')
    run = scored_headless(BASE.at({'wear_gain': 0.9}), chosen, packaged_limits())
    row = row_of(run)
    assert (row['valid'], row['state']) == (False, 'invalid')
    assert 'diverging' in str(row['reason'])
    assert row['engagement_time_s'] is row['slip_final_rpm'] is None
    sound = scored_headless(BASE.at({}), 'pi', packaged_limits())
    assert row.keys() == row_of(sound).keys()
