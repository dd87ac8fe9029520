# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Remarks on values that no car has and on an early score window; they are allowed."""

import math
from collections.abc import Mapping
from dataclasses import replace

from ddct_plant.models.gearbox import RATIOS_OF_CARS
from ddct_plant.scenario.scenario import Scenario

RANGES: Mapping[str, tuple[float, float, str]] = {
    'vehicle.mass_kg': (300.0, 50_000.0, 'kg'),
    'vehicle.wheel_radius_m': (0.15, 0.7, 'm'),
    'driveline.engine_inertia': (0.02, 5.0, 'kg m^2'),
    'driveline.shaft_inertia': (1e-4, 1.0, 'kg m^2'),
    'driveline.vehicle_inertia': (10.0, 20_000.0, 'kg m^2'),
    'driveline.halfshaft_stiffness': (500.0, 500_000.0, 'N m/rad'),
}
"""Least and largest value of cars and trucks and its unit, by key; a value beyond this wide range
is probably in another unit."""


def with_remarks(scenario: Scenario) -> Scenario:
    """Return the scenario with a line in `adjusted` for each value that is probably a mistake."""
    lines = [line for key in RANGES if (line := _remark(scenario, key))]
    lines += _of_gear(scenario) + _of_window(scenario)
    new = [line for line in lines if line not in scenario.adjusted]
    return replace(scenario, adjusted=(*scenario.adjusted, *new)) if new else scenario


def _remark(scenario: Scenario, key: str) -> str:
    least, most, unit = RANGES[key]
    section, _, name = key.partition('.')
    value = float(_values(scenario, section)[name])
    if math.isnan(value) or least <= value <= most:
        return ''
    has = f'{least:g} to {most:g} {unit}'.strip()
    given = f'{value:g} {unit}'.strip()
    return f'{key} is {given}, but cars and trucks have {has}: is it in another unit?'


def _of_gear(scenario: Scenario) -> list[str]:
    least, most = RATIOS_OF_CARS
    ratio = scenario.driveline.values()['total_ratio']
    if least <= ratio <= most:
        return []
    return [
        f'gear {scenario.gear} has the total ratio {ratio:g}, but cars and trucks have {least:g} '
        f'to {most:g}: are gearbox.ratios and gearbox.final_drives right?'
    ]


def _of_window(scenario: Scenario) -> list[str]:
    (first, last), start = scenario.score_window_s, scenario.control_start_s
    if first >= start:
        return []
    return [
        f'score_window_s {[first, last]} begins before control_start_s, {start:g} s: it also '
        'scores time without feedback'
    ]


def _values(scenario: Scenario, section: str) -> Mapping[str, float]:
    """Return the values of a section, those of the driveline in the engaged gear."""
    return scenario.driveline.values() if section == 'driveline' else vars(scenario.vehicle)
