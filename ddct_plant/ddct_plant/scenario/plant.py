# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The models of a run by its settings; nodes and the headless loop make them here."""

from collections.abc import Callable

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import steps_in
from ddct_plant.friction.driveline import FrictionDriveline
from ddct_plant.friction.engagements import (
    EngagedGears,
    both_engaged,
    off_going_engaged,
    on_coming_engaged,
    one_clutch,
)
from ddct_plant.models.actuator import Actuator
from ddct_plant.models.clutch import FrictionClutch, LinearClutch
from ddct_plant.models.engine import Engine
from ddct_plant.models.initial_state import InitialState
from ddct_plant.models.linear_driveline import Driveline
from ddct_plant.models.load import HoldingTorque, RoadLoad, air_and_slope
from ddct_plant.scenario.rules.driveline import least_usual
from ddct_plant.scenario.rules.shift import gears_of
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import AnySettings, RunSettings
from ddct_plant.sensors.sensed import DrivelineSensors, TorqueEstimate
from ddct_plant.shift.gear_pair import GearPair
from ddct_plant.shift.parameters import ShiftParameters
from ddct_plant.shift.roles import ON_COMING

OPEN_BELOW = 0.01
"""Torque in N m of the actuator up to which a clutch of a shift is open."""
_Engaged = Callable[[GearPair], EngagedGears]


def make_driveline(settings: RunSettings, initial: InitialState) -> Driveline | FrictionDriveline:
    """
    Return the driveline of the run's clutch model in its initial state.

    Raise ParameterError for parameters that cannot be integrated, such as a shaft without weight.
    """
    scenario = settings.scenario
    try:
        if settings.stick_slip:
            engaged, changes = engagements(scenario)
            return FrictionDriveline(engaged, scenario.vehicle, initial, changes)
        return Driveline(scenario.driveline, scenario.vehicle, initial)
    except ParameterError as error:
        raise ParameterError(
            f'{least_usual(scenario.driveline)}: the driveline cannot be integrated with the '
            f'clutch {scenario.clutch}: give inertias, damping and stiffness of a car ({error})',
            key=least_usual(scenario.driveline).partition(' ')[0],
            place=f'scenario {scenario.name}',
        ) from error


def engagements(scenario: Scenario) -> tuple[EngagedGears, dict[int, EngagedGears]]:
    """Return the gears that are engaged at t_0, and those that are from a step on."""
    if scenario.shift is None:
        return one_clutch(scenario.driveline), {}
    gears, (first, changes) = gears_of(scenario), engagement_steps(scenario.shift)
    return first(gears), {step: engaged(gears) for step, engaged in changes.items()}


def engagement_steps(shift: ShiftParameters) -> tuple[_Engaged, dict[int, _Engaged]]:
    """Return what engages the gears of a shift at t_0, and what does from a step on."""
    first: _Engaged = both_engaged
    changes: dict[int, _Engaged] = {}
    if preselection := steps_in('shift.preselection_s', shift.preselection_s):
        first, changes[preselection] = off_going_engaged, both_engaged
    if shift.disengagement_s is not None:
        disengagement = steps_in('shift.disengagement_s', shift.disengagement_s)
        changes[disengagement] = on_coming_engaged
    return first, changes


def make_engine(settings: AnySettings) -> Engine:
    """Return the engine of the scenario, with its authority and limits."""
    scenario = settings.scenario
    return Engine(scenario.demand, scenario.engine_authority, scenario.engine_limits)


def make_actuator(settings: RunSettings, initial_request: float) -> Actuator:
    """Return the actuator of a clutch, in its steady state for the request before t_0 in N m."""
    return Actuator(initial_request, settings.scenario.actuator)


def linear_clutch(settings: RunSettings) -> LinearClutch:
    """Return the linear clutch of the thesis."""
    return LinearClutch(settings.case.wear_gain)


def friction_clutch(settings: RunSettings, role: str = ON_COMING) -> FrictionClutch:
    """Return the stick-slip clutch of a role, with its wear, at its initial temperatures."""
    scenario = settings.scenario
    case = settings.case
    wear_gain = case.wear_gain if role == ON_COMING else case.off_going_wear_gain
    open_below = OPEN_BELOW if settings.shift else 0.0
    return FrictionClutch(scenario.friction, wear_gain, scenario.heat, open_below)


def make_load(settings: AnySettings) -> RoadLoad:
    """Return the road load at the wheel; in stick-slip runs without rolling resistance."""
    scenario = settings.scenario
    if settings.stick_slip:
        return air_and_slope(scenario.load, scenario.vehicle, scenario.slope)
    return RoadLoad(scenario.load, scenario.vehicle, scenario.slope)


def holding_torque(settings: AnySettings) -> HoldingTorque:
    """Return the friction at the wheel of a stick-slip run: rolling resistance and brake."""
    scenario = settings.scenario
    load = RoadLoad(scenario.load, scenario.vehicle, scenario.slope)
    return HoldingTorque(load, scenario.brake)


def driveline_sensors(settings: RunSettings) -> DrivelineSensors | None:
    """Return the sensors of the driveline, None for a run without sensors."""
    sensors = settings.scenario.sensors
    return DrivelineSensors(sensors, settings.case.seed) if sensors else None


def torque_estimate(settings: RunSettings) -> TorqueEstimate | None:
    """Return the estimate of C_m, None for a run without sensors."""
    sensors = settings.scenario.sensors
    return TorqueEstimate(sensors, settings.case.seed) if sensors else None
