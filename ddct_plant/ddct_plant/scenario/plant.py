# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The models of a run by its settings, and their initial state.

Nodes and the headless loop make their models here.
"""

from dataclasses import replace

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.actuator import Actuator
from ddct_plant.models.clutch import FrictionClutch, LinearClutch
from ddct_plant.models.driveline import OPEN
from ddct_plant.models.engine import Engine
from ddct_plant.models.initial_state import InitialState
from ddct_plant.models.linear_driveline import Driveline
from ddct_plant.models.load import HoldingTorque, RoadLoad, air_and_slope
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.models.stick_slip_driveline import (
    StickSlipDriveline,
)
from ddct_plant.scenario.rules.driveline import least_usual
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.sensors.sensed import DrivelineSensors, TorqueEstimate


def make_driveline(settings: RunSettings, initial: InitialState) -> Driveline | StickSlipDriveline:
    """
    Return the driveline of the run's clutch model in its initial state.

    Raise ParameterError for parameters that cannot be integrated, such as a shaft without weight.
    """
    scenario = settings.scenario
    model = StickSlipDriveline if settings.stick_slip else Driveline
    try:
        return model(scenario.driveline, scenario.vehicle, initial)
    except ParameterError as error:
        raise ParameterError(
            f'{least_usual(scenario.driveline)}: the driveline cannot be integrated with the '
            f'clutch {settings.clutch}: give inertias, damping and stiffness of a car ({error})',
            key=least_usual(scenario.driveline).partition(' ')[0],
            place=f'scenario {scenario.name}',
        ) from error


def make_engine(settings: RunSettings) -> Engine:
    """Return the engine of the scenario, with its authority and limits."""
    scenario = settings.scenario
    return Engine(scenario.engine, scenario.engine_authority, scenario.engine_limits)


def make_actuator(settings: RunSettings, initial: InitialState) -> Actuator:
    """Return the actuator of the plant, in its steady state for the run's first request."""
    return Actuator(initial.torque_request, settings.scenario.actuator)


def linear_clutch(settings: RunSettings) -> LinearClutch:
    """Return the linear clutch of the thesis."""
    return LinearClutch(settings.wear_gain)


def stick_slip_clutch(settings: RunSettings) -> FrictionClutch:
    """Return the stick-slip clutch at its initial temperatures."""
    scenario = settings.scenario
    return FrictionClutch(scenario.friction, settings.wear_gain, scenario.heat)


def make_load(settings: RunSettings) -> RoadLoad:
    """Return the road load at the wheel; in stick-slip runs without rolling resistance."""
    scenario = settings.scenario
    if settings.stick_slip:
        return air_and_slope(scenario.load, scenario.vehicle, scenario.slope)
    return RoadLoad(scenario.load, scenario.vehicle, scenario.slope)


def holding_torque(settings: RunSettings) -> HoldingTorque:
    """Return the friction at the wheel of a stick-slip run: rolling resistance and brake."""
    scenario = settings.scenario
    load = RoadLoad(scenario.load, scenario.vehicle, scenario.slope)
    return HoldingTorque(load, scenario.brake)


def driveline_sensors(settings: RunSettings) -> DrivelineSensors | None:
    """Return the sensors of the driveline, None for a run without sensors."""
    sensors = settings.scenario.sensors
    return DrivelineSensors(sensors, settings.seed) if sensors else None


def torque_estimate(settings: RunSettings) -> TorqueEstimate | None:
    """Return the estimate of C_m, None for a run without sensors."""
    sensors = settings.scenario.sensors
    return TorqueEstimate(sensors, settings.seed) if sensors else None


def initial_request(settings: RunSettings) -> float:
    """
    Return the request in N m of the clutch before the run; in a shift that of the on-coming one.

    It is C_fOL in `detailed`, and where the scenario starts with a clutch that is locked or
    slipping. It is zero for an open clutch, as is the on-coming one of a shift.
    """
    return 0.0 if settings.shift else initial_state(settings).torque_request


def initial_state(settings: RunSettings) -> InitialState:
    """
    Return the state at t_0 of a run with these settings that is no shift.

    Before the run the request is C_fOL in `detailed`, and where the scenario starts with a clutch
    that is locked or slipping.
    """
    scenario = settings.scenario
    driveline = scenario.driveline
    wheel_speed = driveline.gear.wheel_speed(scenario.initial.shaft_speed_rad_s)
    load_torque = RoadLoad(scenario.load, scenario.vehicle, scenario.slope).torque(
        wheel_speed * scenario.vehicle.wheel_radius_m
    )
    engine_speed = scenario.initial.engine_speed_rad_s
    engine_torque = make_engine(settings).torque(0, speed=engine_speed)
    static = StaticTorque(driveline, scenario.equilibrium)
    shaft_speed = scenario.initial.shaft_speed_rad_s
    static_torque = static.torque(engine_torque, load_torque, engine_speed, shaft_speed)
    phase = scenario.initial.clutch_phase
    engaged = settings.detailed if phase is None else phase != OPEN
    torque_request = max(static_torque, 0.0) if engaged else 0.0
    clutch_torque = LinearClutch(settings.wear_gain).transmit([torque_request])[0]
    initial = InitialState(
        engine_speed=engine_speed,
        shaft_speed=shaft_speed,
        wheel_speed=wheel_speed,
        twist=static.twist(clutch_torque, load_torque, shaft_speed),
        engine_torque=engine_torque,
        load_torque=load_torque,
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
