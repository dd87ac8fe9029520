# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""An engine delivers the demand, and what its authority leaves of a request."""

import math

import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.engine import Engine, EngineAuthority, EngineResponse, TorqueProfile
from ddct_plant.scenario.file import load_scenario

DEMAND = 100.0
PROFILE = TorqueProfile((0.0, 1.0), (0.0, 200.0))


def delivered(authority: EngineAuthority, requests: list[float]) -> list[float]:
    response = EngineResponse(authority)
    return [response.deliver(DEMAND, request) for request in requests]


def test_without_requests_the_engine_follows_the_profile():
    engine = Engine(PROFILE, EngineAuthority(deviation_n_m=1.0))
    assert [engine.torque(engine.demand(step)) for step in (0, 50, 100, 150)] == [
        0.0,
        100.0,
        200.0,
        200.0,
    ]


def test_free_authority_follows_any_request_at_once():
    assert delivered(EngineAuthority(), [40.0, 180.0, 100.0]) == [40.0, 180.0, 100.0]


def test_the_deviation_is_limited_either_way():
    limits = EngineAuthority(deviation_n_m=15.0)
    assert delivered(limits, [50.0, 108.0, 150.0]) == [85.0, 108.0, 115.0]


def test_the_rate_is_that_of_the_deviation():
    limits = EngineAuthority(slew_n_m_s=500.0)
    assert delivered(limits, [112.0, 112.0, 112.0, 98.0]) == [105.0, 110.0, 112.0, 107.0]
    engine = Engine(PROFILE, limits)
    # The demand rises by 2 N m per period, which the rate does not count.
    requests = [engine.demand(step) + 100.0 for step in range(4)]
    torques = [
        engine.torque(engine.demand(step), request) for step, request in enumerate(requests)
    ]
    assert torques == pytest.approx([5.0, 12.0, 19.0, 26.0])


def test_the_lag_is_of_first_order():
    torques = delivered(EngineAuthority(lag_s=0.05), [110.0] * 10)
    expected = [DEMAND + 10.0 * (1.0 - math.exp(-0.2 * step)) for step in range(1, 11)]
    assert torques == pytest.approx(expected)


def test_the_torque_limits_come_last():
    limits = EngineAuthority(minimum_torque_n_m=95.0, maximum_torque_n_m=103.0)
    assert delivered(limits, [0.0, 200.0]) == [95.0, 103.0]


@pytest.mark.parametrize(
    'authority',
    [
        EngineAuthority(),
        EngineAuthority(deviation_n_m=15.0, slew_n_m_s=700.0),
        EngineAuthority(slew_n_m_s=300.0, minimum_torque_n_m=95.0, maximum_torque_n_m=103.0),
        EngineAuthority(deviation_n_m=0.0),
        EngineAuthority(slew_n_m_s=0.0),
    ],
)
@pytest.mark.parametrize('periods', [1, 2, 5])
def test_what_is_reachable_is_delivered_and_nothing_beyond(authority, periods):
    lowest, highest = EngineResponse(authority).reachable(DEMAND, periods)
    assert lowest <= 0.0 <= highest
    for request, expected in (
        (lowest, lowest),
        (highest, highest),
        (lowest - 5.0, lowest),
        (highest + 5.0, highest),
    ):
        torques = delivered(authority, [DEMAND + request] * periods)
        assert torques[-1] == pytest.approx(DEMAND + expected)


def test_a_demand_that_leaves_the_limits_makes_no_empty_range():
    limits = EngineAuthority(deviation_n_m=50.0, slew_n_m_s=100.0, maximum_torque_n_m=200.0)
    response = EngineResponse(limits)
    response.deliver(190.0, 200.0)
    lowest, highest = response.reachable(300.0, 1)
    assert lowest == highest == pytest.approx(response.requested - 1.0)


@pytest.mark.parametrize(
    ('name', 'value', 'key'),
    [
        ('deviation_n_m', -1.0, 'engine_authority.deviation_n_m'),
        ('slew_n_m_s', math.nan, 'engine_authority.slew_n_m_s'),
        (
            'slew_n_m_s',
            2e6,
            'engine_authority.slew_n_m_s',
        ),
        ('lag_s', 'fast', 'engine_authority.lag_s'),
        ('lag_s', -0.1, 'engine_authority.lag_s'),
        ('minimum_torque_n_m', 1000.0, 'engine_authority.minimum_torque_n_m'),
        ('maximum_torque_n_m', math.inf, 'engine_authority.maximum_torque_n_m'),
    ],
)
def test_bad_values_are_named(name, value, key):
    with refused(ParameterError, key=key):
        EngineAuthority(**{name: value})


def test_a_scenario_sets_the_authority_and_an_unknown_key_is_named():
    scenario = load_scenario('thesis', ['engine_authority.lag_s=0.05'])
    assert scenario.engine_authority == EngineAuthority(lag_s=0.05)
    assert load_scenario('thesis').engine_authority == EngineAuthority()
    with refused(ParameterError, key='engine_authority.lag'):
        load_scenario('thesis', ['engine_authority.lag=0.05'])
