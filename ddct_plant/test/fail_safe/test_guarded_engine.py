# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A commanded engine goes on over missing requests, and back to the demand when they stop."""

import pytest

from ddct_plant.fail_safe.guarded import GuardedEngine
from ddct_plant.models.engine import Engine, EngineAuthority, EngineResponse, TorqueProfile
from ddct_plant.models.engine_limits import EngineLimits

DEMAND = 308.0
SLOW = EngineAuthority(slew_n_m_s=500.0, lag_s=0.03)


def guarded(authority: EngineAuthority = SLOW) -> GuardedEngine:
    return GuardedEngine(Engine(TorqueProfile((0.0,), (DEMAND,)), authority), 0.05)


def bare(requests: list[float], authority: EngineAuthority = SLOW) -> list[float]:
    response = EngineResponse(authority)
    return [response.deliver(DEMAND, request) for request in requests]


def test_with_every_request_it_is_the_engine_itself():
    engine, requests = guarded(), [320.0, 330.0, 290.0]
    answers = [engine.request(step, request) for step, request in enumerate(requests)]
    assert answers == bare(requests)


def test_its_limits_are_those_at_the_speed_of_the_period_with_a_request_or_without():
    def limited() -> Engine:
        return Engine(TorqueProfile((0.0,), (DEMAND,)), EngineAuthority(), EngineLimits())

    engine, bare_engine = GuardedEngine(limited(), 0.05), limited()
    engine.speed = 110.0
    assert engine.request(0, 320.0) == bare_engine.torque(DEMAND, 320.0, 110.0) < 200.0
    assert [engine.tick(step) for step in range(1, 6)] == [None] * 5
    engine.speed = 300.0
    for _ in range(1, 6):
        bare_engine.torque(DEMAND, 320.0, 300.0)
    assert engine.tick(6) == bare_engine.torque(DEMAND, DEMAND, 300.0) > 200.0


@pytest.mark.parametrize('skipped', [1, 2, 4])
def test_slew_and_lag_go_on_over_steps_without_a_request(skipped):
    engine = guarded()
    engine.request(0, 400.0)
    answer = engine.request(1 + skipped, 380.0)
    assert answer == bare([400.0] * (1 + skipped) + [380.0])[-1]


def test_the_demand_takes_over_one_step_after_the_timeout_and_no_request_counts_any_more():
    engine = guarded(EngineAuthority(slew_n_m_s=500.0))
    assert engine.request(0, 320.0) == 313.0
    assert [engine.tick(step) for step in range(1, 6)] == [None] * 5
    before = engine.watch.stopped
    assert engine.tick(6) == 315.0, 'the request was held for five steps, then the demand'
    assert (before, engine.watch.stopped) == (False, True)
    assert engine.request(7, 400.0) is None
    assert [engine.tick(step) for step in (7, 7, 8, 9, 6)] == [310.0, 310.0, 308.0, 308.0, None]


def test_until_the_first_request_the_demand_is_delivered():
    engine = guarded(EngineAuthority(slew_n_m_s=500.0))
    assert engine.tick(5) is None
    assert engine.tick(6) == DEMAND
    assert not engine.watch.stopped
    assert engine.request(6, 320.0) is None
    assert engine.request(7, 320.0) == DEMAND + 5.0


def test_one_tick_after_a_pause_of_any_length_gives_the_torque_of_its_last_step():
    engine = guarded()
    engine.request(0, 400.0)
    assert engine.tick(214_748_364_700) == pytest.approx(bare([400.0] * 1000 + [DEMAND])[-1])
