# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The table of nouns: each key of a scenario belongs to the car, to the drive or to the file."""

import difflib
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any

from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.key_names import scenario_key_hint, scenario_options

CAR, DRIVE = 'car', 'drive'
NOUNS = (CAR, DRIVE)
SCENARIO = 'scenario'
"""Owner of the keys that stand in a scenario file beside `car`, `drive` and `set`."""
_OF: Mapping[str, tuple[str, ...]] = {
    CAR: (
        'vehicle.mass_kg',
        'vehicle.wheel_radius_m',
        'vehicle.driven_share',
        'vehicle.height_over_wheelbase',
        'load.frontal_area_m2',
        'load.drag_coefficient',
        'load.rolling_coefficient',
        'driveline',
        'gearbox',
        'engine_limits',
        'engine_authority',
        'clutch',
        'friction',
        'heat.plate_j_k',
        'heat.facing_j_k',
        'heat.housing_j_k',
        'heat.facing_share',
        'heat.facing_to_plate_w_k',
        'heat.plate_to_housing_w_k',
        'heat.housing_to_ambient_w_k',
        'actuator',
        'sensors',
    ),
    DRIVE: (
        'duration_s',
        'control_start_s',
        'score_window_s',
        'pedal_position',
        'gear',
        'shift',
        'initial',
        'engine',
        'brake',
        'slope',
        'load.slope_rad',
        'load.wind_speed_m_s',
        'load.air_density_kg_m3',
        'vehicle.gravity_m_s2',
        'heat.ambient_c',
        'heat.plate_c',
        'heat.facing_c',
        'heat.housing_c',
        'equilibrium',
        'reference',
        'slip_reference',
        'engine_speed_reference',
        'closing',
    ),
    SCENARIO: ('name', 'description', 'controllers', 'adjusted'),
}
"""Keys and whole sections by their owner."""
_OWNERS = {key: owner for owner, keys in _OF.items() for key in keys}


def owner_of(key: str) -> str | None:
    """
    Return the owner of a dotted key or section: CAR, DRIVE or SCENARIO.

    None is that of an unknown key, and of a section with keys of both nouns.
    """
    while key:
        if key in _OWNERS:
            return _OWNERS[key]
        key = key.rpartition('.')[0]
    return None


@cache
def is_shared(section: str) -> bool:
    """Return whether a section has keys of both nouns."""
    return section not in _OWNERS and any(key.startswith(f'{section}.') for key in _OWNERS)


def require_keys_of(noun: str, content: Mapping[str, Any], prefix: str = '') -> None:
    """
    Refuse a key in the content of a noun that is not one of its keys, with where it belongs.

    Keys within a section that belongs to the noun as a whole are checked with their values.
    """
    for name, value in content.items():
        key = f'{prefix}{name}'
        owner = owner_of(key)
        if owner == noun:
            continue
        if is_shared(key) and (value is None or isinstance(value, Mapping)):
            require_keys_of(noun, value or {}, f'{key}.')
            continue
        if is_shared(key):
            raise ParameterError(f'{key}: give keys and values, not {value!r}', key=key)
        if owner is None:
            hint = _hint(noun, str(name), prefix)
            raise ParameterError(f'unknown key {key}: {hint}', key=key)
        raise ParameterError(f'{key} is a key of the {owner}: move it there', key=key)


def by_noun(content: Mapping[str, Any], prefix: str = '') -> dict[str, dict[str, Any]]:
    """Return the parts of nested mappings that belong to each owner; unknown keys are left out."""
    parts: dict[str, dict[str, Any]] = {owner: {} for owner in _OF}
    for name, value in content.items():
        key = f'{prefix}{name}'
        if owner := owner_of(key):
            parts[owner][name] = value
        elif is_shared(key) and isinstance(value, Mapping):
            for each, part in by_noun(value, f'{key}.').items():
                if part:
                    parts[each][name] = part
    return parts


def _hint(noun: str, name: str, prefix: str) -> str:
    """Return a hint for an unknown key: one of the noun before any other."""
    names = list(_names(noun, prefix))
    if close := difflib.get_close_matches(name, names, n=1):
        return f'did you mean {prefix}{close[0]}?'
    return scenario_key_hint(name, names, prefix)


def _names(noun: str, prefix: str) -> Iterator[str]:
    """Yield the names at one level of the content of a noun."""
    for key in (*scenario_options(), *_OF[noun]):
        name = key.removeprefix(prefix).partition('.')[0]
        if key.startswith(prefix) and owner_of(key) == noun:
            yield name
