# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Rules for what a drive asks of a car: no more than its engine and its clutch can give.

They are for the car and the drive that controllers know. What varies for the plant alone may ask
more, since nothing checks it on the road. Each rule is necessary and not sufficient: a drive that
keeps it may still not engage.
"""

from collections.abc import Callable, Iterable

from ddct_plant.base.clutch_kinds import STICK_SLIP
from ddct_plant.base.errors import ParameterError
from ddct_plant.models.driveline import LOCKED
from ddct_plant.models.load import RoadLoad
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.scenario.control import REFERENCE_SHAPES
from ddct_plant.scenario.scenario import Scenario

_ROUNDING = 1.0 + 1e-9
"""Factor by which a demand may exceed the torque of the engine: a share of it is rounded."""
_RAMP = REFERENCE_SHAPES[0]


def require_able(scenario: Scenario) -> None:
    """
    Raise ParameterError that names the first thing that engine or clutch cannot give.

    With the linear clutch there is no greatest torque, and the car has no brake.
    """
    _require_engine(scenario)
    if scenario.clutch == STICK_SLIP:
        _require_clutch(scenario)
        _require_start(scenario)
        _require_reference(scenario)


def _require_engine(scenario: Scenario) -> None:
    """Refuse a demand above the largest torque at full load."""
    limits = scenario.engine_limits
    if limits is None:
        return
    most = limits.most_torque
    demand = max(map(scenario.demand.at, _times(scenario)))
    if demand > most * _ROUNDING:
        raise ParameterError(
            f'engine.{scenario.engine.quantity} asks for {demand:g} N m, but the engine gives at '
            f'most {most:g} N m at full load (engine_limits.full_load_n_m): ask for less, take a '
            'stronger engine, or a drive that asks for a share of full load, such as launch',
            key=f'engine.{scenario.engine.quantity}',
        )


def _require_clutch(scenario: Scenario) -> None:
    """Refuse a demand with which a locked clutch would have to carry more than its capacity."""
    friction, times = scenario.friction, _times(scenario)
    carried = max(map(_constant_slip_torque(scenario), times))
    most = friction.static_over_kinetic * friction.most_n_m
    if carried > most:
        raise ParameterError(
            f'engine.{scenario.engine.quantity} asks for up to '
            f'{max(map(scenario.demand.at, times)):g} N m, of which a locked clutch has to carry '
            f'{carried:.0f} N m, but it carries at most {most:g} N m (friction.most_n_m): ask for '
            'less, or take a stronger clutch',
            key=f'engine.{scenario.engine.quantity}',
        )


def _require_start(scenario: Scenario) -> None:
    """Refuse a start from rest against more torque than engine and clutch have at any time."""
    if scenario.shift or scenario.initial.shaft_speed_rad_s:
        return
    road, brake = RoadLoad(scenario.load, scenario.vehicle, scenario.slope), scenario.brake
    still = min(
        road.torque(0.0, time) + (brake.at(time) if brake.given else 0.0)
        for time in _times(scenario)
    )
    needed = scenario.driveline.gear.shaft_torque(still)
    limits, most = scenario.engine_limits, scenario.friction.most_n_m
    part, key = 'clutch', 'friction.most_n_m'
    if limits and limits.most_torque < most:
        part, key, most = 'engine', 'engine_limits.full_load_n_m', limits.most_torque
    if needed > most:
        braked = brake.given and min(brake.torque_n_m) > 0.0
        raise ParameterError(
            f'the car cannot move off: slope, rolling and brake hold it with at least '
            f'{needed:.0f} N m at the clutch, but the {part} gives at most {most:g} N m ({key}): '
            f'{"release the brake" if braked else "give less slope or a lower gear"}',
            key='brake.torque_n_m' if braked else 'load.slope_rad',
        )


def _require_reference(scenario: Scenario) -> None:
    """
    Refuse a slip reference that falls faster than the clutch can brake the engine.

    Slip that falls at a mean rate a takes C_fOL + J_m J_eq/(J_m + J_eq) a on average.
    """
    initial, reference = scenario.initial, scenario.reference
    start_s, slip = (
        scenario.control_start_s,
        initial.engine_speed_rad_s - initial.shaft_speed_rad_s,
    )
    if initial.clutch_phase == LOCKED or slip <= 0.0 or reference.shape not in REFERENCE_SHAPES:
        return
    key, rate = 'reference.slope_rad_s2', reference.slope_rad_s2
    if reference.shape != _RAMP:
        lasts_s = reference.reference_end_s - start_s
        if lasts_s <= 0.0:  # refused by a rule of its own
            return
        key, rate = 'reference.reference_end_s', slip / lasts_s
    ends = start_s, start_s + slip / rate
    within = [time for time in _times(scenario) if ends[0] < time < ends[1]]
    p = scenario.controlled_driveline
    inertia = (
        p.engine_inertia * p.vehicle_side_inertia / (p.engine_inertia + p.vehicle_side_inertia)
    )
    least = min(map(_constant_slip_torque(scenario), (*ends, *within)))
    needed, most = least + inertia * rate, scenario.friction.most_n_m
    if needed > most:
        raise ParameterError(
            f'{key} is {getattr(reference, key.partition(".")[2]):g}: a slip that falls by '
            f'{rate:.0f} rad/s^2 takes {needed:.0f} N m of the clutch, but it carries at most '
            f'{most:g} N m (friction.most_n_m): let the reference fall more slowly',
            key=key,
        )


def _constant_slip_torque(scenario: Scenario) -> Callable[[float], float]:
    """Return C_fOL in N m as a function of the time in s, with the speeds of the start."""
    initial, vehicle = scenario.initial, scenario.vehicle
    static = StaticTorque(scenario.controlled_driveline, scenario.equilibrium)
    wheel_speed = scenario.driveline.gear.wheel_speed(initial.shaft_speed_rad_s)
    road = RoadLoad(scenario.load, vehicle, scenario.slope)
    speeds = initial.engine_speed_rad_s, initial.shaft_speed_rad_s

    def torque(time_s: float) -> float:
        load = road.torque(wheel_speed * vehicle.wheel_radius_m, time_s)
        return static.torque(scenario.demand.at(time_s), load, *speeds)

    return torque


def _times(scenario: Scenario) -> Iterable[float]:
    """Return the times in s of the run between which all profiles are linear."""
    points = {*scenario.engine.time_s, *scenario.slope.time_s, *scenario.brake.time_s}
    inner = (time for time in points if 0.0 < time < scenario.duration_s)
    return 0.0, *inner, scenario.duration_s
