"""The models of a run, as its settings choose them; nodes and the headless loop take them here."""

import math

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import options_of
from ddct_plant.models.actuator import Actuator
from ddct_plant.models.clutch import STICK_SLIP, LinearClutch
from ddct_plant.models.clutch_heat import ClutchHeat
from ddct_plant.models.driveline import Driveline, InitialState
from ddct_plant.models.engine import Engine
from ddct_plant.models.friction_clutch import FrictionClutch
from ddct_plant.models.holding import HoldingTorque, air_and_slope
from ddct_plant.models.load import RoadLoad
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.stick_slip_clutch import StickSlipClutch
from ddct_plant.models.stick_slip_driveline import (
    StickSlipDriveline,
    friction_integrator,
    friction_system,
)
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.sensors.sensed import DrivelineSensors, TorqueEstimate


def require_driveline(parameters: DrivelineParameters, clutch: str) -> None:
    """
    Raise ParameterError with a key for a driveline that cannot be integrated.

    With either clutch if clutch and wheels cannot stick together, as H_S G_S is singular; with
    the one that sticks also if its rates are too fast for the pieces of 1 ms.
    """
    try:
        if clutch == STICK_SLIP:
            friction_integrator(parameters)
        else:
            friction_system(parameters)
    except (ParameterError, ArithmeticError) as error:
        raise ParameterError(
            f'{_least_usual(parameters)}: give inertias, damping and stiffness of a car ({error})'
        ) from error


def make_driveline(settings: RunSettings, initial: InitialState) -> Driveline | StickSlipDriveline:
    """
    Return the driveline in its initial state; `step` takes what the clutch of the run gives.

    Raise ParameterError for parameters that cannot be integrated, such as a shaft without weight.
    """
    scenario = settings.scenario
    model = StickSlipDriveline if settings.stick_slip else Driveline
    try:
        return model(scenario.driveline, scenario.vehicle, initial)
    except ParameterError as error:
        raise ParameterError(
            f'scenario {scenario.name}: {_least_usual(scenario.driveline)}: the driveline cannot '
            f'be integrated with the clutch {settings.clutch}: give inertias, damping and '
            f'stiffness of a car ({error})'
        ) from error


def _least_usual(parameters: DrivelineParameters) -> str:
    """Return the value that is furthest from its default, as a ratio, with its key."""
    ratios = {
        name: abs(math.log(getattr(parameters, name)) - math.log(option.default))
        for name, option in options_of(DrivelineParameters).items()
        if option.default > 0.0 and getattr(parameters, name) > 0.0
    }
    name = max(ratios, key=lambda name: ratios[name])
    return f'{parameters.prefix}{name} is {getattr(parameters, name):g}'


def make_engine(settings: RunSettings) -> Engine:
    """Return the engine of the scenario, within its authority and limits."""
    scenario = settings.scenario
    return Engine(scenario.engine, scenario.engine_authority, scenario.engine_limits)


def end_cause(scenario: Scenario, engine_speed: float) -> str | None:
    """Return why a run ends early with the engine at w_m in rad/s, None where it goes on."""
    limits = scenario.engine_limits
    return limits.end_cause(engine_speed) if limits else None


def cut_speed(scenario: Scenario) -> float:
    """Return w_m in rad/s from which the rev limiter cuts the fuel, infinite without one."""
    limits = scenario.engine_limits
    return limits.cut_rad_s if limits else math.inf


def make_actuator(settings: RunSettings, initial: InitialState) -> Actuator:
    """Return the actuator of the plant, at rest on the run's first request."""
    return Actuator(initial.torque_request, settings.scenario.actuator)


def linear_clutch(settings: RunSettings) -> LinearClutch:
    """Return the thesis's clutch."""
    return LinearClutch(settings.wear_gain)


def stick_slip_clutch(settings: RunSettings) -> StickSlipClutch:
    """Return the clutch that sticks, at its first temperatures."""
    scenario = settings.scenario
    return StickSlipClutch(
        FrictionClutch(scenario.friction, settings.wear_gain), ClutchHeat(scenario.heat)
    )


def make_load(settings: RunSettings) -> RoadLoad:
    """Return the load at the wheel, in stick-slip runs that of air and slope alone."""
    scenario = settings.scenario
    if settings.stick_slip:
        return air_and_slope(scenario.load, scenario.vehicle, scenario.slope)
    return RoadLoad(scenario.load, scenario.vehicle, scenario.slope)


def holding_torque(settings: RunSettings) -> HoldingTorque:
    """Return the friction at the wheel of a stick-slip run: rolling resistance and brake."""
    scenario = settings.scenario
    return HoldingTorque(scenario.load, scenario.vehicle, scenario.brake, scenario.slope)


def driveline_sensors(settings: RunSettings) -> DrivelineSensors | None:
    """Return what measures the driveline, None where control is told the truth."""
    sensors = settings.scenario.sensors
    return DrivelineSensors(sensors, settings.seed) if sensors else None


def torque_estimate(settings: RunSettings) -> TorqueEstimate | None:
    """Return what estimates C_m, None where control is told the truth."""
    sensors = settings.scenario.sensors
    return TorqueEstimate(sensors, settings.seed) if sensors else None
