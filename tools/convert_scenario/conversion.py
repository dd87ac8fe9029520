# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
What a scenario file of before meant, in the keys of today.

A key that it lacks had its default, which is that of the C635. Its clutch was an option of the
programs, and its gear was known by `driveline.total_ratio`, which a measured gear has today.
"""

import math
import os
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ddct_plant.base.errors import ParameterError
from ddct_plant.files.input_file import SCHEMA_KEY, named_in
from ddct_plant.models.gearbox import EngagedGear, Gearbox
from ddct_plant.models.parameters import VehicleParameters
from ddct_plant.scenario.choices.scenarios import is_packaged
from ddct_plant.scenario.csv_profiles import SECTIONS as PROFILES
from ddct_plant.scenario.csv_profiles import file_of
from ddct_plant.scenario.nouns.keys import SCENARIO, is_shared, owner_of
from ddct_plant.scenario.nouns.part import Text
from ddct_plant.scenario.nouns.places import places_of
from ddct_plant.scenario.nouns.written import texts_by_file

_SPEED_RAD_S = 160.0
"""Speed that a plate had at the start where the file gave none."""
_GEAR = 2
"""Gear of a file that gave neither gear nor total ratio."""


def converted(file: Path, target: Path, clutch: str) -> dict[Path, str]:
    """Return the texts of scenario, car and drive by path; raise DdctError for another file."""
    name = str(file)
    text = Text(SCENARIO, f'./{name}' if is_packaged(name) else name)
    content, lines = text.content()
    with places_of(text.label, lines).located():
        content = _today({'name': file.stem, **content}, clutch)
    for name in PROFILES:
        if csv := file_of(content.get(name)):
            path = named_in(file.parent, str(csv)).absolute()
            content[name] = {**content[name], 'csv': os.path.relpath(path, target.parent)}
    return texts_by_file(content, target)


def _today(content: dict[str, Any], clutch: str) -> dict[str, Any]:
    """Return the content in the keys of today."""
    if content.get(SCHEMA_KEY, 1) != 1:
        raise ParameterError(f'{SCHEMA_KEY} is {content[SCHEMA_KEY]!r}: it is none of before')
    content = {key: value for key, value in content.items() if key not in (SCHEMA_KEY, 'adjusted')}
    for key, value in content.items():
        if owner_of(key) is None and not (is_shared(key) and isinstance(value, Mapping)):
            raise ParameterError(f'{key} is no key of a scenario of before', key=key)
    content = {key: content[key] for key in content if key not in ('vehicle', 'driveline')} | {
        **_gear(content),
        **{section: keys for section, keys in _body(content).items() if keys},
        **_start(content),
    }
    return {**content, 'clutch': clutch}


def _section(content: Mapping[str, Any], name: str) -> dict[str, Any]:
    section = content.get(name) or {}
    if not isinstance(section, Mapping):
        raise ParameterError(f'{name}: give keys and values, not {section!r}', key=name)
    return dict(section)


def _gear(content: Mapping[str, Any]) -> dict[str, Any]:
    """Return gear and gearbox, in which the gear has the total ratio that the file gives."""
    number = content.get('gear')
    total = _section(content, 'driveline').get('total_ratio')
    box = Gearbox()
    if total is not None and number is not None:
        measured = dict(zip(box.measured_gears, box.measured_ratios, strict=True))
        measured[number] = total
        numbers, ratios = tuple(measured), tuple(measured.values())
        box = Gearbox(box.ratios, box.final_drives, numbers, ratios)
    elif total is not None:
        box, number = box.with_measured(EngagedGear(total))
    found: dict[str, Any] = {'gear': _GEAR if number is None else number}
    if box != Gearbox():
        found['gearbox'] = {name: list(values) for name, values in asdict(box).items()}
    return found


def _body(content: Mapping[str, Any]) -> dict[str, Any]:
    """Return mass, radius and inertia of the vehicle, all where the file gave one of them."""
    usual, vehicle = VehicleParameters(), _section(content, 'vehicle')
    driveline = _section(content, 'driveline')
    driveline.pop('total_ratio', None)
    given = driveline.get('vehicle_inertia')
    if given is not None or {'mass_kg', 'wheel_radius_m'} & vehicle.keys():
        radius = vehicle.setdefault('wheel_radius_m', usual.wheel_radius_m)
        square, mass = radius * radius, usual.mass_kg
        if given is not None and not math.isclose(given, mass * square, rel_tol=1e-9):
            mass = given / square
        vehicle.setdefault('mass_kg', mass)
        driveline.setdefault('vehicle_inertia', vehicle['mass_kg'] * square)
    return {'vehicle': vehicle, 'driveline': driveline}


def _start(content: Mapping[str, Any]) -> dict[str, Any]:
    """Return the speeds at the start, also those that were defaults."""
    initial = _section(content, 'initial')
    initial.setdefault('shaft_speed_rad_s', _SPEED_RAD_S)
    if not content.get('shift'):  # else that of the off-going shaft, which follows
        initial.setdefault('engine_speed_rad_s', _SPEED_RAD_S)
    return {'initial': initial}
