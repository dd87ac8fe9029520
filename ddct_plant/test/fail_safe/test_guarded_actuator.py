# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The actuator holds what is missing, opens the clutch when requests stop, and stays open."""

import pytest

from ddct_plant.fail_safe.guarded import GuardedActuator
from ddct_plant.fail_safe.request_watch import FailSafeSettings
from ddct_plant.models.actuator import Actuator

TIMEOUT_STEPS = 5
RAMP_PER_STEP = 10.0


def guarded(initial: float = 200.0) -> GuardedActuator:
    return GuardedActuator(Actuator(initial), initial, FailSafeSettings(0.05, 1000.0))


def bare(requests: list[float], initial: float = 200.0) -> list[list[float]]:
    actuator = Actuator(initial)
    return [actuator.update(request) for request in requests]


def test_with_every_request_it_is_the_actuator_itself():
    actuator, requests = guarded(), [210.0, 190.0, -5.0, 300.0]
    answers = [actuator.request(step, request) for step, request in enumerate(requests)]
    assert answers == bare(requests)


def test_steps_without_a_request_hold_the_last_one():
    actuator = guarded()
    actuator.request(0, 300.0)
    assert actuator.tick(3) is None
    assert actuator.request(4, 100.0) == bare([300.0] * 4 + [100.0])[-1]


def test_the_clutch_opens_one_step_after_the_timeout_at_the_stated_rate():
    actuator = guarded()
    actuator.request(0, 200.0)
    assert [actuator.tick(step) for step in range(1, 6)] == [None] * TIMEOUT_STEPS
    answers = [actuator.tick(step) for step in range(6, 40)]
    ramp = [max(200.0 - RAMP_PER_STEP * (i + 1), 0.0) for i in range(34)]
    assert answers == bare([200.0] * 6 + ramp)[6:]
    assert actuator.watch.stopped


def test_it_ignores_requests_after_its_safe_state():
    actuator = guarded()
    actuator.request(0, 200.0)
    assert actuator.tick(6) is not None
    assert actuator.request(7, 500.0) is None
    ramp = [190.0, 180.0, 170.0]
    assert actuator.tick(8) == bare([200.0] * 6 + ramp)[-1]
    assert all(actuator.request(step, 500.0) is None for step in range(9, 100))
    assert actuator.tick(100)[-1] == pytest.approx(0.0, abs=1e-9)


def test_the_ramp_goes_on_over_ticks_that_were_skipped():
    all_ticks, some_ticks = guarded(), guarded()
    for actuator in (all_ticks, some_ticks):
        actuator.request(0, 200.0)
        actuator.tick(6)
    for step in range(7, 16):
        last = all_ticks.tick(step)
    assert some_ticks.tick(15) == last


def test_a_ramp_after_a_pause_of_any_length_ends_at_zero_at_once():
    actuator = guarded()
    actuator.request(0, 200.0)
    actuator.tick(6)
    assert actuator.tick(214_748_364_700)[-1] == pytest.approx(0.0, abs=1e-9)


def test_a_slow_ramp_after_a_long_pause_has_moved_by_rate_times_time():
    actuator = GuardedActuator(Actuator(200.0), 200.0, FailSafeSettings(0.05, 1.0))
    actuator.request(0, 200.0)
    actuator.tick(6)
    assert actuator.tick(10_006)[-1] == pytest.approx(200.0 - 100.01, abs=0.5)


def test_a_tick_that_comes_again_gets_the_same_torque_and_an_older_one_none():
    actuator = guarded()
    actuator.request(0, 200.0)
    first, second = actuator.tick(6), actuator.tick(7)
    assert actuator.tick(7) == second != first
    assert actuator.tick(6) is None


def test_a_late_request_is_ignored():
    actuator = guarded()
    actuator.request(4, 200.0)
    assert actuator.request(4, 300.0) is None
    assert actuator.request(3, 300.0) is None
