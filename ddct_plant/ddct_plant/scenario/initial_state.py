# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The state of a run at t_0 by its settings, and the request before it."""

from dataclasses import replace
from typing import NamedTuple

from ddct_plant.models.clutch import LinearClutch
from ddct_plant.models.driveline import OPEN
from ddct_plant.models.initial_state import InitialState
from ddct_plant.models.load import RoadLoad
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.scenario.plant import holding_torque, make_engine, make_load, stick_slip_clutch
from ddct_plant.scenario.settings import RunSettings


def initial_request(settings: RunSettings) -> float:
    """
    Return the request in N m of the clutch before the run; in a shift that of the on-coming one.

    It is C_fOL in `detailed`, and where the scenario starts with a clutch that is locked or
    slipping, of the car that a controller knows. It is zero for an open clutch, as is the
    on-coming one of a shift.
    """
    return 0.0 if settings.shift else _before(settings.known).torque_request


class _Before(NamedTuple):
    """The drive before t_0 of a run that is no shift, in N m and rad/s."""

    static: StaticTorque
    wheel_speed: float
    load_torque: float
    engine_torque: float
    torque_request: float


def _before(settings: RunSettings) -> _Before:
    """Return the drive before t_0, with the request that these settings give."""
    scenario, initial = settings.scenario, settings.scenario.initial
    wheel_speed = scenario.driveline.gear.wheel_speed(initial.shaft_speed_rad_s)
    load_torque = RoadLoad(scenario.load, scenario.vehicle, scenario.slope).torque(
        wheel_speed * scenario.vehicle.wheel_radius_m
    )
    engine_speed = initial.engine_speed_rad_s
    engine_torque = make_engine(settings).torque(0, speed=engine_speed)
    static = StaticTorque(scenario.driveline, scenario.equilibrium)
    carried = static.torque(engine_torque, load_torque, engine_speed, initial.shaft_speed_rad_s)
    phase = initial.clutch_phase
    engaged = settings.detailed if phase is None else phase != OPEN
    request = max(carried, 0.0) if engaged else 0.0
    return _Before(static, wheel_speed, load_torque, engine_torque, request)


def initial_state(settings: RunSettings) -> InitialState:
    """
    Return the state at t_0 of a run with these settings that is no shift.

    The car is the true one; its actuator is at rest at the request of the known settings.
    """
    initial_speeds = settings.scenario.initial
    before, torque_request = _before(settings), initial_request(settings)
    shaft_speed = initial_speeds.shaft_speed_rad_s
    clutch_torque = LinearClutch(settings.wear_gain).transmit([torque_request])[0]
    initial = InitialState(
        engine_speed=initial_speeds.engine_speed_rad_s,
        shaft_speed=shaft_speed,
        wheel_speed=before.wheel_speed,
        twist=before.static.twist(clutch_torque, before.load_torque, shaft_speed),
        engine_torque=before.engine_torque,
        load_torque=before.load_torque,
        torque_request=torque_request,
        clutch_torque=clutch_torque,
    )
    return _with_friction(settings, initial) if settings.stick_slip else initial


def _with_friction(settings: RunSettings, linear: InitialState) -> InitialState:
    """
    Return the initial state of a stick-slip run, from that of the linear clutch.

    Plates that slip transmit the kinetic capacity of the first request against their slip. Plates
    of one speed are locked, and carry the torque that keeps them so, at most the static capacity.
    Wheels at rest stay so in the same way, and the shaft between them and the clutch rests too.
    """
    scenario = settings.scenario
    static = StaticTorque(scenario.driveline, scenario.equilibrium)
    load_torque = make_load(settings).torque(linear.wheel_speed * scenario.vehicle.wheel_radius_m)
    holding = holding_torque(settings).capacity(0.0)
    resisting = load_torque + holding
    slip = linear.engine_speed - linear.shaft_speed
    capacity = stick_slip_clutch(settings).reply(0, [linear.torque_request], slip, 0.0)
    (kinetic,), (static_capacity,) = capacity.kinetic, capacity.static
    if slip:
        clutch_torque = kinetic if slip > 0.0 else -kinetic
    else:
        carried = static.torque(
            linear.engine_torque, resisting, linear.engine_speed, linear.shaft_speed
        )
        clutch_torque = _within(carried, static_capacity)
    wheel_torque = holding
    twist = static.twist(clutch_torque, resisting, linear.shaft_speed)
    if linear.wheel_speed == 0.0:
        shaft_torque = scenario.driveline.gear.wheel_torque(clutch_torque)
        wheel_torque = _within(shaft_torque - load_torque, holding)
        twist = shaft_torque / scenario.driveline.halfshaft_stiffness
    return replace(
        linear,
        twist=twist,
        load_torque=load_torque,
        clutch_torque=clutch_torque,
        wheel_torque=wheel_torque,
        clutch_open=not static_capacity,
    )


def _within(torque: float, most: float) -> float:
    return min(max(torque, -most), most)
