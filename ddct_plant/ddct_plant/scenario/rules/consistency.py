# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Consistency of scenario values that depend on each other: which of them hold.

    J_v = m_v r_w^2     driveline.vehicle_inertia, vehicle.mass_kg, vehicle.wheel_radius_m
    the score window    control_start_s, score_window_s
    a shift's start     initial.engine_speed_rad_s, initial.shaft_speed_rad_s, both gears

J_v is left out of the scenario where it follows from mass and radius, and is computed where it is
used. Where both values are given and contradict each other the scenario is refused.
"""

import math
from collections.abc import Mapping
from dataclasses import replace

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import steps_in, time_of_step
from ddct_plant.models.gearbox import AGREE
from ddct_plant.models.parameters import IDENTIFIED_VEHICLE_INERTIA
from ddct_plant.scenario.scenario import Scenario

DEFAULT, FILE, SET = 0, 1, 2
"""Origins of a value; a value of a higher origin holds, one of a lower origin follows."""
SAME = 1e-9
"""Largest relative difference of J_v from the identified one that needs no remark."""
Origins = Mapping[str, int]
"""FILE or SET by dotted key; a missing key has its default."""


INERTIA, MASS = 'driveline.vehicle_inertia', 'vehicle.mass_kg'
RADIUS = 'vehicle.wheel_radius_m'
ENGINE_SPEED, SHAFT_SPEED = 'initial.engine_speed_rad_s', 'initial.shaft_speed_rad_s'


def consistent(scenario: Scenario, origins: Origins, start_before: float | None) -> Scenario:
    """
    Return the scenario with consistent values; each that follows has a line in `adjusted`.

    `start_before` is `control_start_s` in s of the file, before `--set`. Raise ParameterError
    where given values contradict each other, or where the score window would be empty.
    """
    scenario = without_derived(_with_mass(scenario, origins))
    scenario = _with_locked_off_going_clutch(scenario, origins)
    if start_before is not None and _origin(origins, 'control_start_s') > _origin(
        origins, 'score_window_s'
    ):
        scenario = _move_window(scenario, start_before)
    return _with_control_in(scenario)


def _with_control_in(scenario: Scenario) -> Scenario:
    """Refuse a score window that ends before control starts; note one that begins before."""
    first, last = scenario.score_window_s
    start = scenario.control_start_s
    if last < start:
        window = [
            time_of_step(_steps(start)),
            time_of_step(_steps(start) + _steps(last) - _steps(first)),
        ]
        raise ParameterError(
            f'score_window_s ends at {last:g} s, before control_start_s, {start:g} s, so nothing '
            f'of the control is scored: give a later window, such as {window}',
            key='score_window_s',
        )
    if first >= start:
        return scenario
    return _with_line(
        scenario,
        f'score_window_s stays at {[first, last]} s although control starts later, at {start:g} s',
    )


def _with_mass(scenario: Scenario, origins: Origins) -> Scenario:
    """
    Decide which of J_v and the mass holds, the other follows from J_v = m_v r_w^2.

    A scenario that gives no J_v, or whose mass is of a higher origin, has that of mass and radius.
    """
    given, vehicle = scenario.given_driveline.vehicle_inertia, scenario.vehicle
    mass, radius, derived = vehicle.mass_kg, vehicle.wheel_radius_m, vehicle.inertia
    square = radius * radius
    if not 0.0 < square < math.inf:
        raise ParameterError(f'{RADIUS} is {radius:g} m: no vehicle has that')
    if given == derived:
        return scenario
    before = IDENTIFIED_VEHICLE_INERTIA if given is None else given
    if math.isclose(before, derived, rel_tol=SAME):
        return scenario
    of_inertia, of_mass = _origin(origins, INERTIA), _origin(origins, MASS)
    formula = f'J_v = m_v r_w^2, with {RADIUS} {radius:g}'
    if given is not None and of_inertia > of_mass:
        heavy = replace(scenario, vehicle=replace(vehicle, mass_kg=given / square))
        about = f'{MASS} moved from {mass:g} to {given / square:g}: {formula}'
        return _with_line(heavy, f'{about} and {INERTIA} {given:g}')
    if given is None or of_inertia < of_mass or _origin(origins, RADIUS) > of_inertia:
        about = f'{INERTIA} moved from {before:g} to {derived:g}: {formula} and {MASS} {mass:g}'
        return _with_line(_without_inertia(scenario), about)
    if not math.isclose(given, derived, rel_tol=AGREE):
        raise ParameterError(
            f'{MASS} is {mass:g} and {INERTIA} is {given:g}, but {formula}: give {INERTIA} '
            f'{derived:g} or {MASS} {given / square:g}, or one of them only'
        )
    return scenario


def _with_locked_off_going_clutch(scenario: Scenario, origins: Origins) -> Scenario:
    """
    Return the scenario with the engine at the speed of the off-going shaft, if it has a shift.

    The engine speed follows where the shaft speed or a gear is of a higher origin.
    """
    shift, initial = scenario.shift, scenario.initial
    if shift is None:
        return scenario
    off_going = scenario.gearbox.gear(shift.off_going_gear)
    speed = off_going.shaft_ratio(scenario.driveline.gear) * initial.shaft_speed_rad_s
    moving = (SHAFT_SPEED, 'shift.off_going_gear', 'gear')
    highest = max(_origin(origins, key) for key in moving)
    agree = math.isclose(initial.engine_speed_rad_s, speed, rel_tol=AGREE)
    if agree or highest <= _origin(origins, ENGINE_SPEED):
        return scenario
    about = (
        f'{ENGINE_SPEED} moved from {initial.engine_speed_rad_s:g} to {speed:g}: the off-going '
        f'clutch is locked in gear {shift.off_going_gear} with {SHAFT_SPEED} '
        f'{initial.shaft_speed_rad_s:g}'
    )
    moved = replace(scenario, initial=replace(initial, engine_speed_rad_s=speed))
    return _with_line(moved, about)


def without_derived(scenario: Scenario) -> Scenario:
    """Return the scenario without a given J_v that is that of mass and radius."""
    if scenario.given_driveline.vehicle_inertia == scenario.vehicle.inertia:
        return _without_inertia(scenario)
    return scenario


def _without_inertia(scenario: Scenario) -> Scenario:
    section = replace(scenario.given_driveline, vehicle_inertia=None)
    return replace(scenario, given_driveline=section)


def _move_window(scenario: Scenario, start_before: float) -> Scenario:
    """Move the score window by the same time as control start."""
    shift = _steps(scenario.control_start_s) - _steps(start_before)
    if not shift:
        return scenario
    before = scenario.score_window_s
    first, last = (time_of_step(_steps(time) + shift) for time in before)
    change = f'control_start_s from {start_before:g} to {scenario.control_start_s:g} s'
    if last > scenario.duration_s:
        raise ParameterError(
            f'{change} would move score_window_s to {[first, last]}, beyond duration_s, '
            f'{scenario.duration_s:g} s: give score_window_s too, or a longer duration_s',
            key='score_window_s',
        )
    about = f'score_window_s moved from {list(before)} to {[first, last]} s with {change}'
    return _with_line(replace(scenario, score_window_s=(first, last)), about)


def _with_line(scenario: Scenario, line: str) -> Scenario:
    """Return the scenario with the line in `adjusted`, added at most once."""
    if line in scenario.adjusted:
        return scenario
    return replace(scenario, adjusted=(*scenario.adjusted, line))


def _origin(origins: Origins, key: str) -> int:
    return origins.get(key, DEFAULT)


def _steps(time_s: float) -> int:
    return steps_in('control_start_s', time_s)
