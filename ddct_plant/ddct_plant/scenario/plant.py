# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The models of a run by its settings; nodes and the headless loop make them here."""

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.actuator import Actuator
from ddct_plant.models.clutch import FrictionClutch, LinearClutch
from ddct_plant.models.engine import Engine
from ddct_plant.models.initial_state import InitialState
from ddct_plant.models.linear_driveline import Driveline
from ddct_plant.models.load import HoldingTorque, RoadLoad, air_and_slope
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
    return Engine(scenario.demand, scenario.engine_authority, scenario.engine_limits)


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
