# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The stored predictions are those of the packaged scenario and of the stored members."""

import pytest

from ddct_bringup.reproduction.calibration.ensemble import members
from ddct_bringup.reproduction.calibration.predicted_values import OPEN_LOOP, predicted_values
from ddct_bringup.thesis.predictions import (
    Prediction,
    kept_predictions,
    predictions_for,
)
from ddct_bringup.thesis.table_5_1 import PREDICTED, THESIS_TABLE
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.scenario import Scenario

FROZEN = load_scenario('thesis')
AGAIN = ('thesis', 'window_3.0_level_high', 'road_load_times_1.5')
"""Scenarios whose values are computed again; those of the others are as stored."""


def scenario(name: str) -> Scenario:
    return FROZEN if name == 'thesis' else next(one for one in members() if one.name == name)


@pytest.mark.slow
@pytest.mark.parametrize('name', AGAIN)
def test_kept_values_are_those_of_the_controllers_as_they_are(name):
    """`calibration --predict` updates the kept values, see docs/thesis/predictions.md."""
    computed = predicted_values(scenario(name))
    kept = {
        key: one.frozen if name == 'thesis' else one.members[name]
        for key, one in kept_predictions().predictions.items()
    }
    assert computed.keys() == kept.keys()
    for key, value in computed.items():
        # A loop that grows without bound repeats to fewer digits on other machines.
        expected = pytest.approx(value, rel=1e-4) if isinstance(value, float) else value
        assert kept[key] == expected, key


def test_every_prediction_has_a_value_for_each_member():
    names = {member.name for member in members()}
    assert len(names) > 20
    assert all(set(one.members) == names for one in kept_predictions().predictions.values())


def test_no_calibrated_value_is_among_the_predictions_of_table_5_1():
    controllers = {name.split(' ')[1] for name in kept_predictions().predictions if '5.1 ' in name}
    predicted = {row.controller for row in THESIS_TABLE if row.use == PREDICTED}
    assert controllers == predicted | {OPEN_LOOP.split(' ')[0]}


def test_predictions_are_given_for_the_unchanged_packaged_scenario_only():
    assert predictions_for(FROZEN) == kept_predictions().predictions
    assert predictions_for(load_scenario('thesis', ['load.slope_rad=0.01'])) == {}


def test_prediction_is_found_by_its_id_in_the_gate():
    found = kept_predictions().predictions['5.1 mpc3 torsion_speed_std_rpm']
    assert found.frozen in found.values
    assert '5.1 pi engagement_time_s' not in kept_predictions().predictions


def test_range_goes_from_the_least_to_the_largest_value_the_frozen_one_included():
    one = Prediction(0.3, {'a': 0.5, 'b': 0.4})
    assert one.text('.2f') == '0.30 to 0.50'
    assert one.contains(0.3)
    assert not one.contains(0.51)


def test_range_of_a_value_that_some_members_lack_is_open_above():
    assert Prediction(None, {'a': 0.5, 'b': 0.4}).text('.1f') == '0.4 to -'
    assert Prediction(None, {'a': None}).text('.1f') == '-'
    assert not Prediction(None, {'a': None}).contains(0.5)


def test_range_of_a_rating_counts_the_scenarios():
    assert Prediction('bad', {'a': 'bad', 'b': 'average'}).text('') == 'bad (2), average (1)'
