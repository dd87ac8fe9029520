# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Phases of the lock of `least_jerk`."""

import pytest

from ddct_controllers.least_jerk.lock import (
    CLOSED,
    CONFIRMING,
    CONFIRMING_STEPS,
    DWELL_STEPS,
    PARTED_STEPS,
    SLIPPING,
    LockPhases,
)

MOST_REQUEST = 500.0
"""Highest request of closed plates in N m."""


def locked():
    lock = LockPhases(MOST_REQUEST)
    for _ in range(DWELL_STEPS + CONFIRMING_STEPS + 1):
        lock.update(0.1)
    return lock


def test_it_closes_after_a_dwell_and_a_confirmation():
    lock = LockPhases(MOST_REQUEST)
    phases = []
    for _ in range(DWELL_STEPS + CONFIRMING_STEPS + 1):
        lock.update(-0.3)
        phases.append(lock.phase)
    assert phases.count(SLIPPING) == DWELL_STEPS - 1
    assert phases.count(CONFIRMING) == CONFIRMING_STEPS + 1
    assert phases[-1] == CLOSED


def test_a_slip_that_runs_through_zero_does_not_count():
    lock = LockPhases(MOST_REQUEST)
    for slip in (3.0, 0.5, 1.5, 0.4, -1.4, 0.2):
        lock.update(slip)
    assert lock.phase == SLIPPING


def test_noise_of_locked_plates_does_not_open_it_and_a_parting_does():
    lock = locked()
    assert not lock.update(1.0)
    assert lock.phase == CLOSED
    assert [lock.update(3.0) for _ in range(PARTED_STEPS)] == [False] * (PARTED_STEPS - 1) + [True]
    assert lock.phase == SLIPPING


def test_two_lost_samples_of_a_speed_do_not_open_it():
    """A car that gains 1.7 rad/s in a period, with w_m as it was before."""
    lock = locked()
    assert not any(lock.update(slip) for slip in 5 * (0.1, -1.7, -3.4, 0.0))
    assert lock.phase == CLOSED


@pytest.mark.parametrize(('slip', 'phase'), [(0.5, CLOSED), (1.5, SLIPPING)])
def test_feedback_starts_with_plates_that_are_locked_or_slip(slip, phase):
    lock = LockPhases(MOST_REQUEST)
    lock.start(slip)
    assert lock.phase == phase


def test_the_torque_rises_with_the_plan_until_confirmed_and_then_to_the_most():
    lock = locked()
    torque = 100.0
    for _ in range(100):
        torque = lock.torque(torque, 50.0, 0.8)
    assert torque == pytest.approx(0.8 * MOST_REQUEST)
    lock.reset()
    lock.update(0.0)
    lock.update(0.0)
    assert lock.phase == CONFIRMING
    assert lock.torque(100.0, 50.0, 0.8) == pytest.approx(100.5)
