# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The driveline with a clutch that sticks and wheels that friction holds."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import scipy
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.friction.driveline import FrictionDriveline
from ddct_plant.friction.engagements import ON_COMING as CLUTCH
from ddct_plant.friction.engagements import WHEEL, one_clutch
from ddct_plant.models.driveline import PHASES
from ddct_plant.models.driveline_model import states_and_torques
from ddct_plant.models.initial_state import InitialSide, InitialState
from ddct_plant.models.linear_driveline import Driveline
from ddct_plant.models.parameters import DrivelineParameters, VehicleParameters

PARAMETERS, VEHICLE = DrivelineParameters(), VehicleParameters()
TAU = PARAMETERS.gear.total_ratio
ROLLING = VEHICLE.mass_kg * VEHICLE.gravity_m_s2 * 0.0125 * VEHICLE.wheel_radius_m


def initial(engine: float, shaft: float, twist: float = 0.0, load: float = 0.0) -> InitialState:
    return InitialState(engine, shaft / TAU, twist, 0.0, load, (InitialSide(shaft),))


def make(state: InitialState, parameters: DrivelineParameters = PARAMETERS) -> FrictionDriveline:
    return FrictionDriveline(one_clutch(parameters), VEHICLE, state)


def phase(driveline: FrictionDriveline) -> str:
    number = driveline.outputs().clutch_phase
    assert number is not None
    return PHASES[int(number)]


def test_while_all_slips_it_moves_as_the_linear_driveline_does():
    random = np.random.default_rng(1)
    start = initial(300.0, 160.0)
    stick_slip, linear = make(start), Driveline(PARAMETERS, VEHICLE, start)
    for _ in range(20):
        engine, load = random.uniform(100.0, 200.0), random.uniform(0.0, 20.0)
        clutch = random.uniform(50.0, 200.0, 11).tolist()
        stick_slip.step(engine, load, ROLLING, clutch, [1.1 * c for c in clutch])
        linear.step(engine, load + ROLLING, clutch)
        assert stick_slip.now.events == []
    found, expected = stick_slip.outputs(), linear.outputs()
    for name in ('joint_position', 'joint_speed', 'joint_effort', 'slip_speed', 'vehicle_accel'):
        assert getattr(found, name) == pytest.approx(getattr(expected, name), rel=1e-10)


@pytest.mark.parametrize('slope', [0.0, 0.12, -0.12])
def test_a_car_at_rest_stays_at_rest_also_on_a_hill(slope):
    """The brake holds it: no speed, no motion and no acceleration, to the last bit."""
    load = VEHICLE.mass_kg * VEHICLE.gravity_m_s2 * math.sin(slope) * VEHICLE.wheel_radius_m
    driveline = make(initial(100.0, 0.0, load=load))
    for _ in range(100):
        driveline.step(0.0, load, ROLLING + 600.0, [0.0] * 11, [0.0] * 11)
    now = driveline.outputs()
    assert (now.joint_position[2], now.joint_speed[2], now.vehicle_speed, now.vehicle_accel) == (
        0.0,
    ) * 4
    assert now.joint_effort[2] == pytest.approx(0.0, abs=1e-9)  # the friction balances the slope
    assert driveline.now.signs[WHEEL] == 0
    assert (phase(driveline), driveline.now.work[CLUTCH]) == ('open', 0.0)


def test_a_car_rolls_back_when_the_brake_is_released_on_a_hill():
    load = VEHICLE.mass_kg * VEHICLE.gravity_m_s2 * 0.12 * VEHICLE.wheel_radius_m
    driveline = make(initial(100.0, 0.0))
    driveline.step(0.0, load, ROLLING + 600.0, [0.0] * 11, [0.0] * 11)
    driveline.step(0.0, load, ROLLING, [0.0] * 11, [0.0] * 11)
    events = [(e.time_s, e.element, e.kind) for e in driveline.now.events]
    assert (0.0, 1, 'release') in events  # the wheels, the last of two elements
    assert driveline.outputs().vehicle_speed < 0.0
    assert driveline.now.work[WHEEL] > 0.0


def test_the_clutch_locks_once_and_carries_what_keeps_the_plates_together():
    driveline = make(initial(170.0, 160.0, twist=0.1))
    events = []
    for _ in range(100):
        driveline.step(60.0, 20.0, ROLLING, [150.0] * 11, [180.0] * 11)
        events += driveline.now.events
    assert [(e.element, e.kind) for e in events] == [(CLUTCH, 'lock')]
    now = driveline.outputs()
    assert now.slip_speed == 0.0
    assert now.joint_speed[0] == pytest.approx(now.joint_speed[1], rel=1e-14)
    assert (phase(driveline), driveline.now.work[CLUTCH]) == ('locked', 0.0)
    inertia = PARAMETERS.engine_inertia + PARAMETERS.shaft_inertia
    shaft = now.joint_effort[3] / TAU + PARAMETERS.shaft_damping * now.joint_speed[1]
    accel = (60.0 - shaft) / inertia
    assert now.joint_effort[1] == pytest.approx(
        60.0 - PARAMETERS.engine_inertia * accel, rel=1e-10
    )


@pytest.mark.parametrize('damping', [5e-324, 1e-60, 7.4e-14, 1e-10])
def test_almost_no_engine_damping_is_as_none_while_the_plates_stick(damping):
    """Identification may give such a damping; it slows the engine by less than 1e-7 rad/s."""
    start = initial(160.0, 160.0)
    damped = make(start, replace(PARAMETERS, engine_damping=damping))
    undamped = make(start)
    for driveline in (damped, undamped):
        for _ in range(100):
            driveline.step(60.0, 20.0, ROLLING, [150.0] * 11, [180.0] * 11)
        assert phase(driveline) == 'locked'
    assert damped.now.state == pytest.approx(undamped.now.state, rel=1e-9)


@pytest.mark.parametrize('engine', [168.0, 152.0])
@pytest.mark.parametrize(('static', 'kind'), [(180.0, 'lock'), (150.0, 'reverse')])
def test_the_event_at_slip_zero_has_the_slip_acceleration_just_before_it(engine, static, kind):
    """The shaft torque at slip zero, about 168 N m, exceeds the kinetic capacity of 150 N m."""
    start = initial(engine, 160.0, twist=0.24 if engine < 160.0 else -0.24)
    torque = 60.0 if engine < 160.0 else -60.0
    driveline, (a, b) = make(start), states_and_torques(PARAMETERS)
    driveline.step(torque, 0.0, 0.0, [150.0] * 11, [static] * 11)
    clutch = math.copysign(150.0, engine - 160.0)

    def slope(_, state):
        return a @ state + b @ [torque, clutch, 0.0]

    def slip(_, state):
        return state[0] - state[1]

    at_zero: Any = slip
    at_zero.terminal = True
    at = start.states
    found = scipy.integrate.solve_ivp(
        slope, (0.0, 0.01), at, events=at_zero, rtol=1e-12, atol=1e-12
    )
    events = driveline.outputs().phase_events
    assert events is not None
    event = events[0]
    assert event.slip_acceleration is not None
    assert event.kind == kind
    assert event.time_s == pytest.approx(found.t_events[0][0], rel=1e-8)
    engine_slope, shaft_slope = slope(0.0, found.y_events[0][0])[:2]
    assert event.slip_acceleration == pytest.approx(engine_slope - shaft_slope, rel=1e-8)
    assert event.slip_acceleration * clutch < 0.0


def test_it_slips_again_where_the_static_capacity_is_exceeded():
    driveline = make(initial(160.0, 160.0, twist=0.05))
    for _ in range(30):
        driveline.step(60.0, 20.0, ROLLING, [150.0] * 11, [180.0] * 11)
    assert phase(driveline) == 'locked'
    falling = np.linspace(150.0, 10.0, 11)
    driveline.step(60.0, 20.0, ROLLING, falling.tolist(), (1.2 * falling).tolist())
    (release,) = driveline.now.events
    assert (release.element, release.kind) == (CLUTCH, 'release')
    assert phase(driveline) == 'slipping'
    assert driveline.outputs().joint_effort[1] == 10.0
    assert driveline.now.work[CLUTCH] > 0.0


def launch_energies(parameters: DrivelineParameters) -> tuple[list[float], list[str]]:
    """Return work in, energy gained and friction work of a launch from rest, and its events."""
    driveline = make(initial(105.0, 0.0), parameters)
    kinds, friction, work_in, before = [], 0.0, 0.0, driveline.outputs().joint_position
    for period in range(250):
        capacity = np.minimum(0.8 * (period + np.linspace(0.0, 1.0, 11)), 180.0).tolist()
        engine, load = min(0.8 * period, 120.0), 30.0
        driveline.step(engine, load, ROLLING, capacity, [1.1 * c for c in capacity])
        now = driveline.outputs().joint_position
        work_in += engine * (now[0] - before[0]) - load * (now[2] - before[2])
        friction += sum(driveline.now.work)
        kinds += [e.kind for e in driveline.now.events]
        before = now
    out, p = driveline.outputs(), parameters
    speeds = np.array(out.joint_speed[:3])
    kinetic = np.array([p.engine_inertia, p.shaft_inertia, p.vehicle_inertia]) @ speeds**2 / 2.0
    elastic = p.halfshaft_stiffness * out.joint_position[3] ** 2 / 2.0
    return [work_in, kinetic + elastic - p.engine_inertia * 105.0**2 / 2.0, friction], kinds


def test_a_launch_without_dampers_loses_no_energy_but_by_friction():
    undamped = replace(PARAMETERS, shaft_damping=0.0, halfshaft_damping=0.0)
    (work_in, gained, friction), kinds = launch_energies(undamped)
    assert {'lock', 'release'} <= set(kinds)
    assert friction > 1000.0
    assert work_in - gained - friction == pytest.approx(0.0, abs=1e-9 * (work_in + friction))


def test_capacities_that_cannot_be_are_refused():
    driveline = make(initial(170.0, 160.0))
    with refused(ParameterError, 'friction element 0'):
        driveline.step(60.0, 20.0, ROLLING, [150.0] * 11, [149.0] * 11)
    with refused(ParameterError, 'friction element 0'):
        driveline.step(60.0, 20.0, ROLLING, [-1.0] * 11, [1.0] * 11)
    with refused(ParameterError, 'friction element 1'):
        driveline.step(60.0, 20.0, -2.0, [1.0] * 11, [1.0] * 11)


def test_the_clutch_is_open_as_soon_as_a_period_ends_without_capacity():
    """The capacity falls to zero within the period, and the next tick has the phase."""
    driveline = make(initial(300.0, 160.0))
    for last, expected in ((50.0, 'slipping'), (0.0, 'open'), (50.0, 'slipping')):
        capacity = np.linspace(100.0 if last else 50.0, last, 11).tolist()
        driveline.step(150.0, 0.0, ROLLING, capacity, capacity)
        assert phase(driveline) == expected
