"""What a base scenario tells of a measured car, and the scenario with what its log says."""

import dataclasses
import math

import numpy as np

from ddct_plant.base.errors import DdctError
from ddct_plant.identification.log_fit import LogFit
from ddct_plant.identification.log_stretches import KnownLoad
from ddct_plant.measured.log import MeasuredLog
from ddct_plant.models.load import RoadLoad
from ddct_plant.scenario.scenario import Scenario

STEEPEST_RAD = 0.6
"""Slope that a scenario may have."""


def load_of(base: Scenario) -> KnownLoad:
    """Return the drag of the base scenario; all else of C_load is a constant that is fitted."""
    road = RoadLoad(base.load, base.vehicle)
    constant = road.torque(-base.load.wind_speed_m_s)

    def drag(wheel_speed: np.ndarray) -> np.ndarray:
        speeds = wheel_speed * base.vehicle.wheel_radius_m
        return np.array([road.torque(each) for each in speeds.tolist()]) - constant

    return drag


def scenario_of(base: Scenario, name: str, fit: LogFit, log: MeasuredLog) -> Scenario:
    """
    Return `base` with the driveline of the fit.

    The wheel radius stays and the mass is J_v / r_w^2. The slope is the one with which rolling
    resistance and slope make the fitted C_load; it stays where C_load was measured. Raise
    DdctError for a C_load that no slope makes.
    """
    driveline = fit.parameters
    vehicle = dataclasses.replace(
        base.vehicle, mass_kg=driveline.vehicle_inertia / base.vehicle.wheel_radius_m**2
    )
    moved = dataclasses.replace(base, vehicle=vehicle)
    load = base.load
    if fit.load_torque is not None and not base.slope.given:
        load = dataclasses.replace(load, slope_rad=_slope(moved, fit.load_torque))
    return dataclasses.replace(
        moved,
        name=name,
        description=(
            f'driveline identified from {log.path.name} (SHA-256 {log.digest}...): '
            f'fitted {", ".join(fit.std)}; all else as in the scenario {base.name}'
        ),
        driveline=driveline,
        load=load,
        gear=base.gear if driveline.total_ratio == base.driveline.total_ratio else None,
    )


def _slope(scenario: Scenario, load_torque: float) -> float:
    """Return the slope a in rad with m g (mu cos a + sin a) r_w = `load_torque`."""
    vehicle, rolling = scenario.vehicle, scenario.load.rolling_coefficient
    weight_torque = vehicle.mass_kg * vehicle.gravity_m_s2 * vehicle.wheel_radius_m
    share = load_torque / weight_torque / math.hypot(1.0, rolling)
    slope = math.asin(share) - math.atan(rolling) if abs(share) <= 1.0 else math.inf
    if abs(slope) > STEEPEST_RAD:
        raise DdctError(
            f'the fitted C_load of {load_torque:.4g} N m at the wheels is no road for a car of '
            f'{vehicle.mass_kg:.4g} kg: check units and signs of the torques'
        )
    return slope
