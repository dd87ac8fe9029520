# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Missing requests are detected at the stated step; the ramp to an open clutch has its rate."""

from fractions import Fraction

import pytest

from ddct_plant.fail_safe.guarded import steps_to_make_up
from ddct_plant.fail_safe.request_watch import FailSafe, FailSafeSettings, RequestWatch


def with_request(step: int, torque: float, settings: FailSafeSettings | None = None) -> FailSafe:
    """Return a fail-safe that has had one request."""
    fail_safe = FailSafe(settings or FailSafeSettings())
    fail_safe.request(step)
    fail_safe.torque = torque
    return fail_safe


def test_fail_safe_holds_for_its_timeout_then_ramps_to_open():
    settings = FailSafeSettings(request_timeout_s=0.05, fail_safe_ramp_n_m_s=1000.0)
    fail_safe = with_request(10, 25.0, settings)
    assert not any(fail_safe.tick(step) for step in range(11, 16))
    assert fail_safe.tick(16)
    assert [fail_safe.next_torque() for _ in range(4)] == [15.0, 5.0, 0.0, 0.0]


def test_fail_safe_stays_engaged_when_requests_come_back():
    fail_safe = with_request(0, 25.0)
    assert fail_safe.tick(20)
    fail_safe.request(21)
    assert fail_safe.tick(21)


def test_fail_safe_does_not_engage_before_the_first_request():
    fail_safe = FailSafe(FailSafeSettings())
    assert not fail_safe.tick(1000)


def test_a_request_restarts_the_timeout():
    watch = RequestWatch(0.05)
    for step in range(0, 100, 5):
        watch.request(step)
        assert not watch.tick(step + 5)
    assert watch.tick(101)


def test_a_late_request_does_not_shorten_the_timeout():
    watch = RequestWatch(0.05)
    watch.request(10)
    watch.request(7)
    assert [watch.tick(step) for step in (15, 16)] == [False, True]


@pytest.mark.parametrize('since', [0, 1, 77])
def test_every_timeout_in_hundredths_of_a_second_trips_one_step_after_it(since):
    for hundredths in range(1, 1001):
        watch = RequestWatch(float(Fraction(hundredths, 100)))
        assert not watch.too_long(since, since + hundredths), hundredths
        assert watch.too_long(since, since + hundredths + 1), hundredths


def test_the_ramp_over_several_periods_is_that_of_each():
    one, several = (with_request(0, 300.0) for _ in range(2))
    for _ in range(7):
        last = one.next_torque()
    assert several.next_torque(7) == last == 230.0
    assert several.next_torque(10**12) == 0.0


def test_a_negative_torque_runs_to_zero_too():
    fail_safe = with_request(0, -15.0)
    assert [fail_safe.next_torque() for _ in range(3)] == [-5.0, 0.0, 0.0]


def test_the_steps_made_up_for_are_bounded_whatever_the_stamp():
    assert list(steps_to_make_up(3, 6)) == [3, 4, 5]
    assert len(steps_to_make_up(0, 214_748_364_800)) == 1000
    assert steps_to_make_up(0, 214_748_364_800)[-1] == 214_748_364_799
