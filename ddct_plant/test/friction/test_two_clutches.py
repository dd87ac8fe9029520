# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The driveline of a shift: its equations, ideal phases of a shift, tie-up and engagement."""

import math
from dataclasses import replace

import numpy as np
import pytest
from refusals import refused
from samples import sampled

from ddct_plant.base.errors import ParameterError
from ddct_plant.friction.driveline import FrictionDriveline
from ddct_plant.friction.engagements import (
    OFF_GOING,
    ON_COMING,
    WHEEL,
    both_engaged,
    off_going_engaged,
    on_coming_engaged,
    one_clutch,
)
from ddct_plant.models.clutch import Capacity
from ddct_plant.models.driveline import PHASES, DrivelineOutputs, OffGoingOutputs
from ddct_plant.models.gearbox import Gearbox
from ddct_plant.models.initial_state import InitialSide, InitialState
from ddct_plant.models.parameters import DrivelineParameters, VehicleParameters
from ddct_plant.shift.gear_pair import GearPair
from ddct_plant.shift.start import driving_start

pytestmark = pytest.mark.slow

PARAMETERS, VEHICLE = DrivelineParameters(), VehicleParameters()
FIRST = Gearbox().gear(1)
GEARS = GearPair(PARAMETERS, FIRST)
TAU_I, TAU_J = FIRST.total_ratio, PARAMETERS.gear.total_ratio
WHEEL_SPEED = 17.3
"""20 km/h, in rad/s."""


def capacity(start: float, end: float | None = None, ratio: float = 1.0) -> Capacity:
    """Return a capacity in N m that is linear over a period, and `ratio` times that at rest."""
    kinetic = np.linspace(start, start if end is None else end, 11).tolist()
    return Capacity(kinetic, [ratio * torque for torque in kinetic], 20.0)


OPEN = capacity(0.0)


def step(
    driveline: FrictionDriveline,
    engine: float,
    load: float,
    on_coming: Capacity,
    off_going: Capacity,
    holding: float,
) -> None:
    """Advance by one period with torques in N m and the capacities of both clutches."""
    driveline.step(engine, load, holding, *on_coming[:2], *off_going[:2])


def at(engine: float, wheel: float, twist: float = 0.0) -> InitialState:
    """Return a start with both gears engaged, at an engine and a wheel speed in rad/s."""
    sides = InitialSide(TAU_J * wheel, open=True), InitialSide(TAU_I * wheel)
    return InitialState(engine, wheel, twist, 0.0, 0.0, sides)


def off_going_of(outputs: DrivelineOutputs) -> OffGoingOutputs:
    """Return the signals of the off-going side."""
    assert outputs.off_going is not None
    return outputs.off_going


def phases(outputs: DrivelineOutputs) -> tuple[str, str]:
    """Return the phases of the on-coming and the off-going clutch."""
    on_coming = outputs.clutch_phase
    assert on_coming is not None
    return PHASES[int(on_coming)], PHASES[int(off_going_of(outputs).clutch_phase)]


def test_the_equations_are_those_at_the_gear_output():
    """J_g = J_p tau_i^2 + J_p tau_j^2 at the wheels, damping likewise, for any state."""
    random = np.random.default_rng(3)
    p = replace(PARAMETERS, engine_damping=0.02)
    system = both_engaged(GearPair(p, FIRST)).integrator.system
    for _ in range(20):
        engine, gear, wheel, twist = random.uniform(-1.0, 1.0, 4) * (300.0, 20.0, 20.0, 0.2)
        c_m, c_1, c_2, load, friction = random.uniform(-200.0, 200.0, 5)
        squares = TAU_I**2 + TAU_J**2
        shaft = p.halfshaft_damping * (gear - wheel) + p.halfshaft_stiffness * twist
        at_gear = TAU_I * c_1 + TAU_J * c_2 - shaft - p.shaft_damping * squares * gear
        engine_slope = (c_m - p.engine_damping * engine - c_1 - c_2) / p.engine_inertia
        gear_slope = at_gear / (p.shaft_inertia * squares)
        wheel_slope = (shaft - load - friction) / p.vehicle_inertia
        state = [engine, TAU_J * gear, wheel, twist, 0.0, 0.0, 0.0, 0.0]
        torques = np.zeros(3)
        torques[[ON_COMING, OFF_GOING, WHEEL]] = c_2, c_1, friction
        slope = system.a @ state + system.b @ [c_m, load] + system.g @ torques
        expected = [engine_slope, TAU_J * gear_slope, wheel_slope, gear - wheel]
        assert slope[:4] == pytest.approx(expected, rel=1e-11, abs=1e-9)
        assert slope[4:] == pytest.approx([engine, TAU_J * gear, wheel, TAU_I * gear], rel=1e-12)
        slips = np.zeros(3)
        slips[[ON_COMING, OFF_GOING, WHEEL]] = engine - TAU_J * gear, engine - TAU_I * gear, wheel
        assert system.h @ state == pytest.approx(slips, rel=1e-12)


def test_in_an_ideal_torque_phase_the_wheel_torque_falls_by_a_third():
    """A slow handover with the off-going clutch locked; 1 - tau_j/tau_i would be 41.8 %."""
    p = replace(PARAMETERS, shaft_damping=0.0)
    gears = GearPair(p, FIRST)
    engine, load = 100.0, 60.0
    shafts = p.shaft_inertia * (TAU_I**2 + TAU_J**2)
    before = (TAU_I * engine - load) / (p.vehicle_inertia + shafts + p.engine_inertia * TAU_I**2)
    after = (TAU_J * engine - load) / (
        p.vehicle_inertia + shafts + p.engine_inertia * TAU_I * TAU_J
    )
    torques = [p.vehicle_inertia * a + load for a in (before, after)]
    driveline = FrictionDriveline(
        both_engaged(gears), VEHICLE, driving_start(gears, 10.0, (engine, load, 0.0))
    )
    found = [driveline.outputs().joint_effort.driveshaft]
    off_going = []
    for period in range(1000):
        on_coming = capacity(0.1 * period, 0.1 * (period + 1))
        step(driveline, engine, load, on_coming, capacity(200.0), 0.0)
        now = driveline.outputs()
        off_going.append(off_going_of(now).transmitted_torque)
        found.append(now.joint_effort.driveshaft)
        assert phases(now) == ('slipping', 'locked')
        if off_going[-1] < 0.0:
            break
    share = off_going[-2] / (off_going[-2] - off_going[-1])
    at_zero = found[-2] + share * (found[-1] - found[-2])
    assert found[0] == pytest.approx(torques[0], rel=1e-12)
    assert at_zero == pytest.approx(torques[1], rel=1e-4)
    dip = 1.0 - at_zero / found[0]
    assert dip == pytest.approx(1.0 - torques[1] / torques[0], rel=1e-3)
    assert dip == pytest.approx(0.338, abs=5e-4)
    assert pytest.approx(0.418, abs=5e-4) == 1.0 - TAU_J / TAU_I


def test_the_work_of_an_inertia_phase_is_that_of_the_engine_and_of_its_kinetic_energy():
    """W = C_m dw t_i/2 + J_m dw^2/2 at constant car speed: 5.12 kJ for 150 N m in 0.3 s."""
    p = replace(PARAMETERS, vehicle_inertia=1e9)
    engine_speed, torque, time_s = 100.0 * math.pi, 150.0, 0.3
    wheel = engine_speed / TAU_I
    slip = engine_speed - TAU_J * wheel
    transmitted = torque + p.engine_inertia * slip / time_s
    damping = p.shaft_damping * (TAU_I**2 + TAU_J**2) * wheel
    twist = (TAU_J * transmitted - damping) / p.halfshaft_stiffness
    driveline = FrictionDriveline(
        both_engaged(GearPair(p, FIRST)), VEHICLE, at(engine_speed, wheel, twist)
    )
    work = 0.0
    for _ in range(32):
        step(driveline, torque, 0.0, capacity(transmitted, ratio=2.0), OPEN, 0.0)
        now = driveline.outputs()
        work += now.friction_work
        for event in now.phase_events:
            assert event.kind == 'lock'
            assert event.time_s == pytest.approx(time_s, rel=1e-3)
    expected = torque * slip * time_s / 2.0 + p.engine_inertia * slip**2 / 2.0
    assert phases(driveline.outputs())[0] == 'locked'
    assert work == pytest.approx(expected, rel=5e-3)
    assert expected == pytest.approx(5115.0, abs=5.0)
    assert p.engine_inertia * slip**2 / 2.0 == pytest.approx(2158.0, abs=3.0)


@pytest.mark.parametrize(
    ('torques', 'ratio', 'rolling'),
    sampled(
        [
            ((2000.0, 2000.0), 1.0, 60.0),
            ((2500.0, 900.0), 1.1, 0.0),
            ((900.0, 2500.0), 1.1, 60.0),
            ((900.0, 2500.0), 1.0, 0.0),
        ],
        every=2,
    ),
)
def test_a_tie_up_brings_car_and_engine_to_rest_and_keeps_them_there(torques, ratio, rolling):
    """An engine without limits, at 20 km/h in first gear; without friction the wheels swing on."""
    start = driving_start(GEARS, WHEEL_SPEED, (100.0, 10.0, rolling))
    driveline = FrictionDriveline(both_engaged(GEARS), VEHICLE, start)
    on_coming, off_going = (capacity(torque, ratio=ratio) for torque in torques)
    at_rest = []
    for period in range(1000):
        step(driveline, 100.0, 0.0, on_coming, off_going, rolling)
        now = driveline.outputs()
        assert np.isfinite([*now.joint_speed, *now.joint_effort]).all()
        if phases(now) == ('locked', 'locked'):
            at_rest.append(period)
            assert now.engine_speed == pytest.approx(0.0, abs=1e-12)
            assert off_going_of(now).shaft_speed == pytest.approx(0.0, abs=1e-12)
            assert (now.slip_speed, off_going_of(now).slip_speed) == (0.0, 0.0)
            carried = now.joint_effort.primary_shaft + off_going_of(now).transmitted_torque
            assert carried == pytest.approx(100.0, abs=1e-9)
    assert at_rest[0] < 100
    assert at_rest[-1] == 999
    if rolling:
        assert now.vehicle_accel == now.joint_speed.wheel == 0.0
    else:
        assert abs(now.joint_speed.wheel) < 1.0


def test_a_tie_up_at_the_capacity_of_the_c635_brakes_the_car_by_the_difference_of_the_ratios():
    """T = tau_i C_m - (tau_i - tau_j) C_2 at the wheels: it takes seconds to stop the engine."""
    start = driving_start(GEARS, WHEEL_SPEED, (100.0, 10.0, 60.0))
    driveline = FrictionDriveline(both_engaged(GEARS), VEHICLE, start)
    inertia = PARAMETERS.vehicle_inertia + TAU_I**2 * PARAMETERS.engine_inertia
    inertia += PARAMETERS.shaft_inertia * (TAU_I**2 + TAU_J**2)
    torque = 100.0 * TAU_I - 350.0 * (TAU_I - TAU_J) - 70.0
    for _ in range(200):
        step(driveline, 100.0, 10.0, capacity(350.0), capacity(350.0), 60.0)
    now = driveline.outputs()
    assert phases(now) == ('slipping', 'locked')
    assert now.wheel_speed == pytest.approx(WHEEL_SPEED + 2.0 * torque / inertia, abs=1.0)
    assert off_going_of(now).transmitted_torque == pytest.approx(-230.0, abs=40.0)


def test_with_one_gear_engaged_it_is_the_driveline_with_one_clutch():
    """Before preselection that in the off-going gear, after disengagement in the on-coming one."""
    start = driving_start(GEARS, WHEEL_SPEED, (100.0, 10.0, 60.0), free_shaft_speed=40.0)
    shift = FrictionDriveline(
        off_going_engaged(GEARS),
        VEHICLE,
        start,
        {20: both_engaged(GEARS), 30: on_coming_engaged(GEARS)},
    )
    one = FrictionDriveline(
        one_clutch(GEARS.in_off_going_gear), VEHICLE, replace(start, sides=start.sides[1:])
    )
    for period in range(20):
        clutch = capacity(120.0 - 5.0 * period, 115.0 - 5.0 * period, ratio=1.1)
        step(shift, 100.0, 10.0, OPEN, clutch, 60.0)
        one.step(100.0, 10.0, 60.0, clutch.kinetic, clutch.static)
        if period < 19:
            both, alone = shift.outputs(), one.outputs()
            assert off_going_of(both).shaft_speed == pytest.approx(alone.shaft_speed, rel=1e-12)
            assert both.wheel_speed == pytest.approx(alone.wheel_speed, rel=1e-12)
            assert both.twist == pytest.approx(alone.twist, rel=1e-10)
            assert both.vehicle_accel == pytest.approx(alone.vehicle_accel, rel=1e-9)
            assert off_going_of(both).clutch_phase == alone.clutch_phase
            assert len(off_going_of(both).phase_events) == len(alone.phase_events)
            for found, expected in zip(
                off_going_of(both).phase_events, alone.phase_events, strict=True
            ):
                assert found.kind == expected.kind
                assert found.time_s == pytest.approx(expected.time_s, abs=1e-12)
    for _ in range(10):
        step(shift, 100.0, 10.0, OPEN, OPEN, 60.0)
    now = shift.outputs()
    engine, shaft, wheel, twist = *now.joint_speed[:3], now.twist
    start = InitialState(engine, wheel, twist, 100.0, 10.0, (InitialSide(shaft),))
    one = FrictionDriveline(one_clutch(PARAMETERS), VEHICLE, start)
    for period in range(40):
        clutch = capacity(6.0 * period, 6.0 * (period + 1))
        step(shift, 100.0, 10.0, clutch, OPEN, 60.0)
        one.step(100.0, 10.0, 60.0, clutch.kinetic, clutch.static)
    both, alone = shift.outputs(), one.outputs()
    assert both.joint_speed == pytest.approx(alone.joint_speed, rel=1e-11, abs=1e-9)
    assert both.friction_work == pytest.approx(alone.friction_work, rel=1e-10)
    assert both.clutch_phase == alone.clutch_phase
    decay = math.exp(-0.4 * PARAMETERS.shaft_damping / PARAMETERS.shaft_inertia)
    assert off_going_of(both).shaft_speed == pytest.approx(
        off_going_of(now).shaft_speed * decay, rel=1e-12
    )


def test_preselection_gives_the_free_shaft_the_speed_of_its_gear():
    start = driving_start(GEARS, WHEEL_SPEED, (100.0, 10.0, 60.0), free_shaft_speed=40.0)
    driveline = FrictionDriveline(
        off_going_engaged(GEARS), VEHICLE, start, {5: both_engaged(GEARS)}
    )
    free, shafts = [], []
    for _ in range(6):
        now = driveline.outputs()
        free.append(now.shaft_speed)
        shafts.append(off_going_of(now).shaft_speed)
        assert phases(now) == ('open', 'locked')
        assert now.slip_speed == now.engine_speed - now.shaft_speed
        step(driveline, 100.0, 10.0, OPEN, capacity(150.0), 60.0)
    decay = math.exp(-0.01 * PARAMETERS.shaft_damping / PARAMETERS.shaft_inertia)
    assert free[:5] == pytest.approx([40.0 * decay**k for k in range(5)], rel=1e-12)
    assert free[5] == pytest.approx(shafts[5] * TAU_J / TAU_I, rel=1e-14)
    gained = PARAMETERS.shaft_inertia * (free[5] ** 2 - (40.0 * decay**5) ** 2) / 2.0
    assert driveline.synchronising_work == pytest.approx(gained, rel=1e-12)
    assert shafts == sorted(shafts)


def test_a_steady_drive_before_the_shift_has_no_oscillation():
    driveline = FrictionDriveline(
        both_engaged(GEARS), VEHICLE, driving_start(GEARS, WHEEL_SPEED, (100.0, 10, 60))
    )
    accels = []
    for _ in range(50):
        accels.append(driveline.outputs().vehicle_accel)
        step(driveline, 100.0, 10.0, OPEN, capacity(150.0), 60.0)
    assert np.ptp(accels) < 0.03
    assert accels[0] > accels[-1] > 2.0  # the shafts' damping grows with speed


def test_gears_and_starts_that_cannot_be_are_refused():
    with refused(ParameterError):
        GearPair(PARAMETERS, PARAMETERS.gear)
    with refused(ParameterError, 'initial.shaft_speed_rad_s'):
        driving_start(GEARS, 0.0, (100.0, 10.0, 60.0))
