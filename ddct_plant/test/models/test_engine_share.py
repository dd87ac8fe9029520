# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The driver's demand as a share of full load."""

import numpy as np
import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.engine import TorqueProfile
from ddct_plant.models.engine_limits import EngineLimits
from ddct_plant.scenario.file import load_scenario, scenario_to_yaml

SHARE = 'engine={time_s: [0.0, 0.5], torque_share: [0.0, 0.56]}'


def test_a_share_is_that_of_the_largest_torque_at_full_load():
    limits = EngineLimits()
    profile = TorqueProfile((0.0, 1.0), torque_share=(0.2, 1.0)).in_n_m(limits)
    assert profile == TorqueProfile((0.0, 1.0), (50.0, max(limits.full_load_n_m)))
    assert profile.in_n_m(None) is profile


@pytest.mark.parametrize('torque', [25.0, 40.0, 100.0, 120.0, 140.0, 240.0])
def test_shares_of_the_packaged_demands_give_their_torques_to_the_last_bit(torque):
    share = TorqueProfile((0.0,), torque_share=(torque / 250.0,))
    assert share.in_n_m(EngineLimits()).torque_n_m == (torque,)


def test_one_share_is_less_torque_of_a_smaller_engine():
    demand = load_scenario('launch', [SHARE]).demand
    assert demand.torque_n_m == (0.0, 140.0)
    smaller = np.multiply(0.7, EngineLimits().full_load_n_m).tolist()
    other = load_scenario('launch', [SHARE, f'engine_limits.full_load_n_m={smaller}']).demand
    assert other.torque_n_m == pytest.approx((0.0, 98.0))


def test_a_share_is_written_and_read_again(tmp_path):
    scenario = load_scenario('launch', [SHARE])
    written = tmp_path / 'written.yaml'
    written.write_text(scenario_to_yaml(scenario))
    assert load_scenario(str(written)).engine == scenario.engine


def test_set_replaces_a_demand_in_the_other_quantity(tmp_path):
    of_share = load_scenario('launch', ['engine.torque_share=[0.1, 0.2]'])
    assert of_share.demand.torque_n_m == (25.0, 50.0)
    file = tmp_path / 'share.yaml'
    file.write_text(scenario_to_yaml(of_share))
    again = load_scenario(str(file), ['engine.torque_n_m=[10, 90]', 'engine.factor=2'])
    assert again.demand.torque_n_m == (20.0, 180.0)


def test_a_file_of_shares_has_the_unit_one(tmp_path, monkeypatch):
    (tmp_path / 'pedal.csv').write_text('t,x\n0,0.1\n1,0.5\n')
    monkeypatch.chdir(tmp_path)
    changes = ["engine={csv: pedal.csv, time: t, value: x, unit: '1'}"]
    assert load_scenario('launch', changes).engine.torque_share == (0.1, 0.5)


@pytest.mark.parametrize(
    ('changes', 'key'),
    [
        (['engine={time_s: [0.0], torque_share: [0.4], torque_n_m: [100.0]}'], 'engine'),
        (['engine={time_s: [0.0]}'], 'engine.torque_n_m'),
        (['engine={time_s: [0.0], torque_share: [1.1]}'], 'engine.torque_share[0]'),
        (['engine={time_s: [0.0, 0.1], torque_share: [0.1]}'], 'engine.torque_share'),
        ([SHARE, 'engine_limits=null'], 'engine.torque_share'),
    ],
)
def test_a_demand_that_is_given_twice_or_not_at_all_is_refused(changes, key):
    with refused(ParameterError, key=key):
        load_scenario('launch', changes)
