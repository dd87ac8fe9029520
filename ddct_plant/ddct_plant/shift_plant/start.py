# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The start of a run with a gear shift: the drive before it, and the clutch that stays locked."""

from ddct_plant.scenario.control import ClosingParameters
from ddct_plant.scenario.plant import holding_torque, make_engine, make_load
from ddct_plant.scenario.rules.shift import gears_of, shift_of
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import RunSettings
from ddct_plant.shift.start import ShiftStart, driving_start


def shift_start(settings: RunSettings) -> ShiftStart:
    """
    Return the state at t_0: the car drives in the off-going gear.

    `initial.shaft_speed_rad_s` is that of the on-coming shaft in its gear, so it gives the speed
    of the car also if the gear is engaged later. Raise ParameterError for a run without a shift,
    and for a car that does not move forward.
    """
    scenario = settings.scenario
    shift, gears = shift_of(scenario), gears_of(scenario)
    wheel_speed = scenario.driveline.gear.wheel_speed(scenario.initial.shaft_speed_rad_s)
    vehicle_speed = wheel_speed * scenario.vehicle.wheel_radius_m
    engine_speed = gears.ratio * scenario.initial.shaft_speed_rad_s
    torques = (
        make_engine(settings).torque(0, speed=engine_speed),
        make_load(settings).torque(vehicle_speed),
        holding_torque(settings).capacity(0.0),
    )
    free = shift.free_shaft_rad_s if shift.preselection_s else None
    return driving_start(gears, wheel_speed, torques, free)


def locked_request(scenario: Scenario, carried: float) -> float:
    """Return the request in N m that keeps a clutch locked that carries a torque in N m."""
    closing = scenario.closing or ClosingParameters()
    carried, most = abs(carried), closing.most_request(scenario.friction)
    return max(min(closing.margin * carried + closing.reserve_n_m, most), carried)
