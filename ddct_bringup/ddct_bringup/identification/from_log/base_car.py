# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What a fit takes of the car and drive that it starts from: the drag, and the wheel radius."""

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ddct_bringup.identification.from_log.stretches import KnownLoad
from ddct_bringup.logs.columns import ColumnMap
from ddct_bringup.logs.log import MeasuredLog
from ddct_bringup.logs.wheel_radius import WHEEL_SPEED, MeasuredRadius, measured_radius
from ddct_plant.models.body import RADIUS
from ddct_plant.models.gearbox import AGREE
from ddct_plant.models.load import RoadLoad
from ddct_plant.scenario.content import flat
from ddct_plant.scenario.overrides import parsed_override
from ddct_plant.scenario.scenario import Scenario

MEASURED, GIVEN, OF_MAP, ASSUMED = 'measured', 'given', 'of the column map', 'assumed'
"""
Origins of a wheel radius: the log, --set, `radius_m` of a wheel speed in km/h or m/s, or only the
car that the fit starts from.
"""


@dataclass(frozen=True)
class WheelRadius:
    """Wheel radius that drag, mass and new car are computed with."""

    value_m: float
    """Radius r_w in m."""
    state: str
    """Origin: MEASURED, GIVEN, OF_MAP or ASSUMED."""
    measured: MeasuredRadius | None
    """Radius of V_x over w_r; None where the log does not have both."""

    @property
    def contradiction(self) -> MeasuredRadius | None:
        """Measured radius where a given one is outside its interval; None elsewhere."""
        found = self.measured
        if not found or self.state != GIVEN or found.lowest_m <= self.value_m <= found.highest_m:
            return None
        return None if math.isclose(self.value_m, found.value_m, rel_tol=AGREE) else found


def radius_of(
    base: Scenario, overrides: Sequence[str], log: MeasuredLog, columns: ColumnMap
) -> WheelRadius:
    """
    Return the wheel radius: that of --set, else that of V_x and w_r, else that of `base`.

    A wheel speed in km/h or m/s is V_x over the `radius_m` of the map. So both measure nothing but
    that radius again, which then is the origin.
    """
    measured, of_base = measured_radius(log), base.vehicle.wheel_radius_m
    of_map = columns.columns[WHEEL_SPEED].radius_m if WHEEL_SPEED in columns.columns else None
    if RADIUS in flat(dict(map(parsed_override, overrides))):
        return WheelRadius(of_base, GIVEN, measured)
    if of_map:
        return WheelRadius(measured.value_m if measured else of_map, OF_MAP, measured)
    if measured:
        return WheelRadius(measured.value_m, MEASURED, measured)
    return WheelRadius(of_base, ASSUMED, None)


def with_radius(base: Scenario, radius: WheelRadius) -> Scenario:
    """Return `base` with another wheel radius."""
    vehicle = dataclasses.replace(base.vehicle, wheel_radius_m=radius.value_m)
    driveline = dataclasses.replace(base.given_driveline, vehicle_inertia=None)
    return dataclasses.replace(base, vehicle=vehicle, given_driveline=driveline)


def drag_of(base: Scenario) -> KnownLoad:
    """Return the drag of `base` as the known part of C_load; the rest is fitted."""
    road = RoadLoad(base.load, base.vehicle)
    constant = road.torque(-base.load.wind_speed_m_s)

    def drag(wheel_speed: np.ndarray) -> np.ndarray:
        speeds = wheel_speed * base.vehicle.wheel_radius_m
        return np.array([road.torque(each) for each in speeds.tolist()]) - constant

    return drag
