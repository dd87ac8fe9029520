# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""An engine with limits delivers what its speed allows, idles, and ends a run by its own fault."""

import math

import numpy as np
import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.units import rad_s_from_rpm
from ddct_plant.models.engine_limits import EngineLimits, LimitedEngine, fuel_is_cut

LIMITS = EngineLimits()
IDLE = LIMITS.idle_rad_s


def test_full_load_limits_the_torque_at_each_speed():
    found = [
        LimitedEngine(LIMITS).deliver(400.0, rad_s_from_rpm(rpm)) for rpm in (2000, 2500, 4000)
    ]
    assert found == pytest.approx([225.0, 250.0, 233.5], rel=1e-4)


def test_what_the_engine_can_give_is_given():
    assert LimitedEngine(LIMITS).deliver(123.4, 300.0) == 123.4


def test_an_engine_with_a_request_below_friction_takes_no_more_than_friction():
    torque = LimitedEngine(LIMITS).deliver(-500.0, rad_s_from_rpm(2000))
    assert torque == pytest.approx(-16.0, rel=1e-3)


def test_the_friction_torque_is_heywoods():
    for speed, torque in zip(LIMITS.speed_rad_s, LIMITS.friction_n_m, strict=True):
        n = speed * 30.0 / math.pi / 1000.0
        pressure = (0.97 + 0.15 * n + 0.05 * n**2) * 1e5
        assert torque == pytest.approx(pressure * 1.368e-3 / (4.0 * math.pi), abs=0.051)


def simulated(engine, speed, load, seconds, request=0.0):
    """Return w_m every 10 ms of an engine of 0.25 kg m^2 that carries `load` in N m."""
    speeds = [speed]
    for _ in range(round(seconds / 0.01)):
        speeds.append(speeds[-1] + (engine.deliver(request, speeds[-1]) - load) / 0.25 * 0.01)
    return speeds


@pytest.mark.parametrize('load', [0.0, 20.0, 50.0])
def test_idle_control_keeps_its_speed_under_a_load_that_it_can_carry(load):
    engine = LimitedEngine(LIMITS)
    speeds = simulated(engine, IDLE, load, 8.0)
    assert speeds[-1] == pytest.approx(IDLE, rel=1e-3)
    assert min(speeds) > LIMITS.stall_rad_s
    assert engine.end_cause is None


def test_idle_control_leaves_an_engine_above_idle_to_the_demand():
    engine = LimitedEngine(LIMITS)
    assert [engine.deliver(torque, 1.5 * IDLE) for torque in (0.0, 30.0)] == [0.0, 30.0]


def test_idle_control_does_not_wind_up_while_it_is_saturated():
    """The torque is at most `idle_most_n_m` in a long overload, and zero a second after it."""
    engine = LimitedEngine(LIMITS)
    for _ in range(10_000):
        assert engine.deliver(0.0, 0.7 * IDLE) <= LIMITS.idle_most_n_m
    request = [engine.deliver(0.0, 1.2 * IDLE) for _ in range(100)]
    assert request[-1] == 0.0


def test_an_engine_loaded_beyond_idle_control_stalls_and_stays_off():
    engine = LimitedEngine(LIMITS)
    simulated(engine, IDLE, 100.0, 1.0)
    assert engine.end_cause == 'stalled'
    assert engine.deliver(200.0, 300.0) == 0.0
    assert engine.end_cause == 'stalled'


def test_the_limiter_cuts_fuel_with_hysteresis():
    engine, cut, resume = LimitedEngine(LIMITS), LIMITS.cut_rad_s, LIMITS.resume_rad_s
    between = 0.5 * (cut + resume)
    speeds = [between, cut, between, resume, resume - 0.1, between]
    found = [engine.deliver(100.0, speed) > 0.0 for speed in speeds]
    assert found == [True, False, False, False, True, True]
    assert (~fuel_is_cut(LIMITS, np.array(speeds))).tolist() == found


def test_a_free_engine_at_full_pedal_hunts_below_the_over_rev_speed():
    engine = LimitedEngine(LIMITS)
    speeds = simulated(engine, 300.0, 0.0, 5.0, request=250.0)
    assert LIMITS.resume_rad_s - 10.0 < min(speeds[-100:]) < LIMITS.cut_rad_s
    assert max(speeds) < LIMITS.over_rev_rad_s
    assert engine.end_cause is None


def test_an_engine_driven_beyond_its_limit_has_over_revved():
    engine = LimitedEngine(LIMITS)
    assert engine.deliver(0.0, LIMITS.over_rev_rad_s + 1.0) < 0.0
    assert engine.end_cause == 'over_revved'


@pytest.mark.parametrize(
    ('bad', 'key'),
    [
        (
            {'speed_rad_s': (0.0, 600.0), 'full_load_n_m': (0.0, 9.0), 'friction_n_m': (1.0, 1.0)},
            'engine_limits.speed_rad_s',
        ),
        (
            {'speed_rad_s': (90.0, 800.0), 'full_load_n_m': (0.0, 9.0), 'friction_n_m': (1.0, 1)},
            'engine_limits.speed_rad_s',
        ),
        (
            {'speed_rad_s': (), 'full_load_n_m': (), 'friction_n_m': ()},
            'engine_limits.speed_rad_s',
        ),
        ({'full_load_n_m': (1.0,)}, 'engine_limits.full_load_n_m'),
        ({'friction_n_m': (-1.0,) * 8}, 'engine_limits.friction_n_m[0]'),
        ({'stall_rad_s': 95.0}, 'engine_limits.stall_rad_s'),
        ({'resume_rad_s': 690.0}, 'engine_limits.resume_rad_s'),
        ({'over_rev_rad_s': 600.0}, 'engine_limits.cut_rad_s'),
        ({'idle_most_n_m': -1.0}, 'engine_limits.idle_most_n_m'),
    ],
)
def test_bad_limits_are_named(bad, key):
    with refused(ParameterError, key=key):
        EngineLimits(**bad)


def test_curves_that_end_early_are_refused_with_the_keys_of_the_rev_limits():
    with pytest.raises(ParameterError, match='give cut_rad_s, resume_rad_s and over_rev_rad_s of'):
        EngineLimits(speed_rad_s=(0.0, 600.0), full_load_n_m=(0.0, 9.0), friction_n_m=(1.0, 1.0))
