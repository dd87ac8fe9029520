# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Consistency of scenario values that depend on each other: a given one moves the other.

    J_v = m_v r_w^2        driveline.vehicle_inertia, vehicle.mass_kg, vehicle.wheel_radius_m
    total ratio of a gear  gear, driveline.total_ratio
    the score window       control_start_s, score_window_s

Where both values are given and contradict each other the scenario is refused. The defaults agree
to rounding, so a scenario that gives none of these is not changed.
"""

import math
from collections.abc import Mapping
from dataclasses import replace
from operator import attrgetter

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import steps_in, time_of_step
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.scenario.scenario import FINAL_DRIVE, GEAR_RATIOS, Scenario

DEFAULT, FILE, SET = 0, 1, 2
"""Origins of a value; a value of a higher origin moves one of a lower origin."""
SAME, AGREE = 1e-9, 1e-3
"""Relative differences: the largest without a move, and the largest between two given values."""
Origins = Mapping[str, int]
"""FILE or SET by dotted key; a missing key has its default."""


INERTIA, MASS = 'driveline.vehicle_inertia', 'vehicle.mass_kg'
RADIUS, RATIO = 'vehicle.wheel_radius_m', 'driveline.total_ratio'


def consistent(scenario: Scenario, origins: Origins, start_before: float | None) -> Scenario:
    """
    Return the scenario with dependent values moved, each with a line in `adjusted`.

    `start_before` is `control_start_s` in s of the file, before `--set`. Raise ParameterError
    where given values contradict each other, or where the score window would be empty.
    """
    scenario = _with_gear(_with_mass(scenario, origins), origins)
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
            f'of the control is scored: give a later window, such as {window}'
        )
    if first >= start:
        return scenario
    return _with_line(
        scenario,
        f'score_window_s stays at {[first, last]} s although control starts later, at {start:g} s',
    )


def _with_mass(scenario: Scenario, origins: Origins) -> Scenario:
    """Keep J_v = m_v r_w^2: move J_v or the mass, whichever has the lower origin."""
    inertia, mass, radius = attrgetter(INERTIA, MASS, RADIUS)(scenario)
    square = radius * radius
    if not 0.0 < square < math.inf:
        raise ParameterError(f'{RADIUS} is {radius:g} m: no vehicle has that')
    if math.isclose(inertia, mass * square, rel_tol=SAME):
        return scenario
    of_inertia, of_mass = _origin(origins, INERTIA), _origin(origins, MASS)
    formula = f'J_v = m_v r_w^2, with {RADIUS} {radius:g}'
    if of_inertia > of_mass:
        return _moved(scenario, MASS, inertia / square, f'{formula} and {INERTIA} {inertia:g}')
    if of_inertia < of_mass or _origin(origins, RADIUS) > of_inertia:
        return _moved(scenario, INERTIA, mass * square, f'{formula} and {MASS} {mass:g}')
    if of_inertia and not math.isclose(inertia, mass * square, rel_tol=AGREE):
        raise ParameterError(
            f'{MASS} is {mass:g} and {INERTIA} is {inertia:g}, but {formula}: give {INERTIA} '
            f'{mass * square:g} or {MASS} {inertia / square:g}, or one of them only'
        )
    return scenario


def _with_gear(scenario: Scenario, origins: Origins) -> Scenario:
    """
    Keep gear and total ratio consistent: a gear moves the ratio, a ratio sets the gear.

    A file with another car's ratio and no gear gets no line in `adjusted`.
    """
    gear, total = scenario.gear, scenario.driveline.total_ratio
    ratios = [ratio * FINAL_DRIVE for ratio in GEAR_RATIOS]
    fits = [g for g, r in enumerate(ratios, 1) if math.isclose(r, total, rel_tol=AGREE)]
    if gear in fits or (gear is None and total == DrivelineParameters().total_ratio):
        return scenario
    of_gear, of_total = _origin(origins, 'gear'), _origin(origins, RATIO)
    if gear is not None and of_gear > of_total:
        return _moved(scenario, RATIO, ratios[gear - 1], f'gear {gear} of the C635')
    if gear is not None and of_gear == of_total:
        raise ParameterError(
            f'gear is {gear} and {RATIO} is {total:g}, but that gear has {ratios[gear - 1]:g}: '
            f'give {RATIO} {ratios[gear - 1]:g}, or one of them only'
        )
    if gear is None and not fits:
        about = f'gear stays none, as no gear of the C635 has {RATIO} {total:g}'
        return _with_line(scenario, about) if of_total == SET else scenario
    name = fits[0] if fits else None
    about = f'gear is now {name or "none"}, as {RATIO} is {total:g}'
    return _with_line(replace(scenario, gear=name), about)


def _moved(scenario: Scenario, key: str, value: float, why: str) -> Scenario:
    group, _, leaf = key.partition('.')
    changed = replace(getattr(scenario, group), **{leaf: value})
    about = f'{key} moved from {attrgetter(key)(scenario):g} to {value:g}: {why}'
    return _with_line(replace(scenario, **{group: changed}), about)


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
            f'{scenario.duration_s:g} s: give score_window_s too, or a longer duration_s'
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
