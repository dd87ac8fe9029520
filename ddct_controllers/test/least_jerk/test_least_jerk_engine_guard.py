# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Guards of the engine speed of `least_jerk`."""

import math

import pytest

from ddct_controllers.least_jerk.engine_guard import (
    ABOVE_IDLE_RAD_S,
    BELOW_CUT_RAD_S,
    EngineGuard,
    SpeedRange,
)
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.engine_limits import EngineLimits
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.static_torque import constant_slip_torque

DRIVELINE = DrivelineParameters()
J_M = DRIVELINE.engine_inertia
LEAST, GUARD_S, MOST = 80.0, 0.15, 340.0
LIMITS = EngineLimits()


def guard(limits=LIMITS):
    return EngineGuard(DRIVELINE, SpeedRange.of(LEAST, limits), GUARD_S, MOST)


@pytest.mark.parametrize(
    ('start', 'planned', 'end'),
    [(200.0, 300.0, LEAST), (600.0, 0.0, LIMITS.cut_rad_s - BELOW_CUT_RAD_S)],
)
def test_the_engine_comes_near_a_speed_of_the_guard_and_does_not_pass_it(start, planned, end):
    speed, demand, speeds = start, 150.0, []
    for _ in range(400):
        speeds.append(speed)
        speed += PERIOD_S / J_M * (demand - guard().bounded(planned, speed, demand))
    assert speeds[-1] == pytest.approx(end, abs=0.1)
    assert min(speeds) > LEAST - 0.1
    assert max(speeds) < LIMITS.cut_rad_s - BELOW_CUT_RAD_S + 0.1


def test_far_from_both_speeds_the_plan_stays():
    assert guard().bounded(120.0, 300.0, 100.0) == 120.0
    assert guard(None).bounded(0.0, 5000.0, 100.0) == 0.0


def test_slipping_plates_get_no_more_than_they_carry_and_none_less_than_nothing():
    assert guard().bounded(1000.0, 300.0, 300.0) == MOST
    assert guard().bounded(-10.0, 300.0, 100.0) == 0.0


def test_a_lock_at_the_earliest_time_leaves_the_engine_at_idle_speed():
    """The mean speed rises as at constant slip, whatever the clutch does until then."""
    engine_torque, engine_speed, shaft_speed = 60.0, 100.0, 20.0
    needed = constant_slip_torque(DRIVELINE, engine_torque, 0.0)
    speeds = (engine_speed, shaft_speed)
    time_s = guard().earliest_s(speeds, engine_torque, needed, math.inf)
    vehicle = DRIVELINE.vehicle_side_inertia
    for step in range(1000):
        torque = 30.0 + 40.0 * math.sin(0.1 * step)
        engine_speed += 1e-3 * time_s / J_M * (engine_torque - torque)
        shaft_speed += 1e-3 * time_s / vehicle * torque
    mean = (J_M * engine_speed + vehicle * shaft_speed) / (J_M + vehicle)
    assert mean == pytest.approx(LIMITS.idle_rad_s + ABOVE_IDLE_RAD_S)


def test_a_slow_way_down_needs_a_later_lock_as_the_engine_turns_more_slowly_before_it():
    speeds, needed = (100.0, 20.0), constant_slip_torque(DRIVELINE, 60.0, 0.0)
    slow, fast = (guard().earliest_s(speeds, 60.0, needed, rate) for rate in (30.0, 300.0))
    assert slow > fast > 0.0


def test_without_idle_control_or_acceleration_no_lock_is_too_early():
    assert guard(None).earliest_s((100.0, 20.0), 60.0, 50.0, 50.0) == 0.0
    assert guard().earliest_s((100.0, 20.0), 60.0, 70.0, 50.0) == 0.0
