# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The rule that admits a scenario uses the nine fitted values, the PI loop and the bounds."""

import dataclasses

from refusals import refused

from ddct_bringup.reproduction.calibration import ensemble
from ddct_bringup.reproduction.calibration.ensemble import fitted_rows, why_not_admissible
from ddct_bringup.reproduction.calibration.parameters import BASE, ROWS
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.scenario import Scenario

SCENARIO = load_scenario('thesis')


def changed(*overrides: str) -> Scenario:
    return load_scenario('thesis', overrides)


def test_frozen_scenario_is_admissible():
    assert why_not_admissible(SCENARIO) == []


def test_value_outside_its_tolerance_is_named():
    assert why_not_admissible(changed('reference.slope_rad_s2=108.0')) == [
        'ls8 torsion_speed_std_rpm -10.8 %'
    ]


def test_nine_values_are_those_of_the_whole_run_in_the_scenarios_own_window():
    longer = dataclasses.replace(SCENARIO, score_window_s=(0.6, 3.0))
    rows = fitted_rows(longer)
    assert len(rows) == 9
    sigmas = [row.computed for row in rows if row.figure != 'engagement_time_s']
    others = [row.computed for row in fitted_rows(SCENARIO)]
    assert not set(sigmas) & set(others)
    times = [row.computed for row in rows if row.figure == 'engagement_time_s']
    assert times == others[::3]


def test_unstable_pi_is_not_admissible_whatever_its_values(monkeypatch):
    monkeypatch.setattr(ensemble, 'pi_growth_rate', lambda *loop: 0.1)
    assert why_not_admissible(SCENARIO) == ['the PI loop grows by 0.1/s']


def test_parameter_beyond_its_bound_is_not_admissible_whatever_its_values():
    """The level of the torque changes no value, so only the bound is violated."""
    both = changed('engine.torque_n_m=[61.0, 365.0]')
    assert why_not_admissible(both) == [
        'torque_start_n_m 61 is outside 0 to 60',
        'torque_end_n_m 365 is outside 150 to 350',
    ]


def test_slip_that_does_not_reach_zero_is_not_admissible():
    slow = changed('reference.slope_rad_s2=40.0', 'duration_s=1.7')
    against = why_not_admissible(slow)
    assert 'hinf1 has no engagement_time_s' in against


def test_no_predictive_controller_is_run(monkeypatch):
    run: list[str] = []
    real = ensemble.study_run

    def noted(settings, name):
        run.append(name)
        return real(settings, name)

    monkeypatch.setattr(ensemble, 'study_run', noted)
    why_not_admissible(SCENARIO)
    assert set(run) == set(ROWS)


def test_scenario_of_another_kind_is_refused():
    with refused(ParameterError, 'thesis'):
        why_not_admissible(BASE)
