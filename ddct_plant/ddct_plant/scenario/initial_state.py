# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The state of a run at t_0 by its settings, and the request of each clutch before it."""

from dataclasses import replace
from typing import NamedTuple

from ddct_plant.models.clutch import LinearClutch
from ddct_plant.models.driveline import OPEN
from ddct_plant.models.initial_state import InitialSide, InitialState
from ddct_plant.models.load import RoadLoad
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.scenario.control import ClosingParameters
from ddct_plant.scenario.plant import friction_clutch, holding_torque, make_engine, make_load
from ddct_plant.scenario.rules.shift import gears_of, shift_of
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import AnySettings, KnownSettings, RunSettings
from ddct_plant.shift.roles import ON_COMING, ROLES
from ddct_plant.shift.start import driving_start


def initial_request(known: KnownSettings, role: str = ON_COMING) -> float:
    """
    Return the request before t_0 in N m of the clutch with a role, for the known car.

    It is C_fOL in `detailed`, and where the scenario starts with a clutch that is locked or
    slipping. It is zero for an open clutch, as is the on-coming one of a shift; that of the
    off-going one keeps it locked.
    """
    if not known.shift:
        return _before(known).torque_request
    if role == ON_COMING:
        return 0.0
    return locked_request(known.scenario, _driving(known).sides[1].torque)


def locked_request(scenario: Scenario, carried: float) -> float:
    """Return the request in N m that keeps a clutch locked that carries a torque in N m."""
    closing = scenario.closing or ClosingParameters()
    carried, most = abs(carried), closing.most_request(scenario.friction)
    return max(min(closing.margin * carried + closing.reserve_n_m, most), carried)


def initial_state(settings: RunSettings) -> InitialState:
    """
    Return the state at t_0 of a run with these settings.

    The car is the true one; its actuators are at rest at the requests of the known settings. Raise
    ParameterError for a shift of a car that does not move forward.
    """
    if settings.shift:
        return _with_requests(settings, _driving(settings))
    linear = _linear(settings)
    return _with_friction(settings, linear) if settings.stick_slip else linear


def _with_requests(settings: RunSettings, driving: InitialState) -> InitialState:
    requests = (initial_request(settings.known, role) for role in ROLES)
    sides = zip(driving.sides, requests, strict=True)
    return replace(
        driving, sides=tuple(replace(side, torque_request=request) for side, request in sides)
    )


def _driving(settings: AnySettings) -> InitialState:
    """
    Return the drive in the off-going gear before a shift, without the requests.

    `initial.shaft_speed_rad_s` is that of the on-coming shaft in its gear, so it gives the speed
    of the car also if the gear is engaged later.
    """
    scenario = settings.scenario
    shift, gears = shift_of(scenario), gears_of(scenario)
    wheel_speed = scenario.driveline.gear.wheel_speed(scenario.initial.shaft_speed_rad_s)
    vehicle_speed = wheel_speed * scenario.vehicle.wheel_radius_m
    engine_speed = gears.ratio * scenario.initial.shaft_speed_rad_s
    engine = make_engine(settings)
    torques = (
        engine.torque(engine.demand(0), speed=engine_speed),
        make_load(settings).torque(vehicle_speed),
        holding_torque(settings).capacity(0.0),
    )
    free = shift.free_shaft_rad_s if shift.preselection_s else None
    return driving_start(gears, wheel_speed, torques, free)


class _Before(NamedTuple):
    """The drive before t_0 of a run that is no shift, in N m and rad/s."""

    static: StaticTorque
    wheel_speed: float
    load_torque: float
    engine_torque: float
    torque_request: float


def _before(settings: AnySettings) -> _Before:
    """Return the drive before t_0, with the request that these settings give."""
    scenario, initial = settings.scenario, settings.scenario.initial
    wheel_speed = scenario.driveline.gear.wheel_speed(initial.shaft_speed_rad_s)
    load_torque = RoadLoad(scenario.load, scenario.vehicle, scenario.slope).torque(
        wheel_speed * scenario.vehicle.wheel_radius_m
    )
    engine_speed = initial.engine_speed_rad_s
    engine = make_engine(settings)
    engine_torque = engine.torque(engine.demand(0), speed=engine_speed)
    static = StaticTorque(scenario.driveline, scenario.equilibrium)
    carried = static.torque(engine_torque, load_torque, engine_speed, initial.shaft_speed_rad_s)
    phase = initial.clutch_phase
    engaged = settings.detailed if phase is None else phase != OPEN
    request = max(carried, 0.0) if engaged else 0.0
    return _Before(static, wheel_speed, load_torque, engine_torque, request)


def _linear(settings: RunSettings) -> InitialState:
    """Return the state before a launch, with the linear clutch."""
    initial_speeds = settings.scenario.initial
    before, torque_request = _before(settings), initial_request(settings.known)
    shaft_speed = initial_speeds.shaft_speed_rad_s
    clutch_torque = LinearClutch(settings.case.wear_gain).transmit([torque_request])[0]
    return InitialState(
        engine_speed=initial_speeds.engine_speed_rad_s,
        wheel_speed=before.wheel_speed,
        twist=before.static.twist(clutch_torque, before.load_torque, shaft_speed),
        engine_torque=before.engine_torque,
        load_torque=before.load_torque,
        sides=(InitialSide(shaft_speed, torque_request, clutch_torque),),
    )


def _with_friction(settings: RunSettings, linear: InitialState) -> InitialState:
    """
    Return the state before a launch of a stick-slip run, from that of the linear clutch.

    Plates that slip transmit the kinetic capacity of the first request against their slip. Plates
    of one speed are locked, and carry the torque that keeps them so, at most the static capacity.
    Wheels at rest stay so in the same way, and the shaft between them and the clutch rests too.
    """
    scenario, (side,) = settings.scenario, linear.sides
    static = StaticTorque(scenario.driveline, scenario.equilibrium)
    load_torque = make_load(settings).torque(linear.wheel_speed * scenario.vehicle.wheel_radius_m)
    holding = holding_torque(settings).capacity(0.0)
    resisting = load_torque + holding
    slip = linear.engine_speed - side.shaft_speed
    capacity = friction_clutch(settings).reply(0, [side.torque_request], slip, 0.0)
    (kinetic,), (static_capacity,) = capacity.kinetic, capacity.static
    if slip:
        clutch_torque = kinetic if slip > 0.0 else -kinetic
    else:
        carried = static.torque(
            linear.engine_torque, resisting, linear.engine_speed, side.shaft_speed
        )
        clutch_torque = _within(carried, static_capacity)
    wheel_torque = holding
    twist = static.twist(clutch_torque, resisting, side.shaft_speed)
    if linear.wheel_speed == 0.0:
        shaft_torque = scenario.driveline.gear.wheel_torque(clutch_torque)
        wheel_torque = _within(shaft_torque - load_torque, holding)
        twist = shaft_torque / scenario.driveline.halfshaft_stiffness
    return replace(
        linear,
        twist=twist,
        load_torque=load_torque,
        sides=(replace(side, torque=clutch_torque, open=not static_capacity),),
        wheel_torque=wheel_torque,
    )


def _within(torque: float, most: float) -> float:
    return min(max(torque, -most), most)
