# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Mass, wheel radius and inertia in the content of files and in overrides, completed by a rule."""

import math
from collections.abc import Collection, Mapping
from typing import Any

from ddct_plant.models.body import BODY, INERTIA, MASS, RADIUS, Body
from ddct_plant.models.parameters import VehicleParameters

_VEHICLE = VehicleParameters()


def with_body(
    content: Mapping[str, Any], before: Mapping[str, Any], keys: Collection[str]
) -> dict[str, Any]:
    """
    Return the content with mass, radius and inertia that agree; both contents are nested.

    `content` is `before` with the values of the dotted `keys`. Values that no vehicle has stay,
    and are refused with the scenario.
    """
    found = dict(content)
    given = {key: _value(content, key) for key in BODY if key in keys}
    given = {key: value for key, value in given.items() if value is not None}
    if not all(map(_usable, given.values())):
        return found
    if given or any(_value(content, key) != _value(before, key) for key in BODY):
        for key, value in derived(before, given).items():
            section, _, name = key.partition('.')
            group = found.get(section, {})
            if isinstance(group, Mapping):
                found[section] = {**group, name: value}
    return found


def derived(before: Mapping[str, Any], given: Mapping[str, float]) -> dict[str, float]:
    """
    Return mass, radius and inertia by key that follow from given ones and a content before.

    Nothing follows where a value would be zero or infinite.
    """
    mass, radius = (
        value if _usable(value := _value(before, key)) else default
        for key, default in ((MASS, _VEHICLE.mass_kg), (RADIUS, _VEHICLE.wheel_radius_m))
    )
    inertia = _value(before, INERTIA)
    body = Body(mass, radius, inertia if _usable(inertia) else mass * (radius * radius))
    changed = body.changed({key: given[key] for key in BODY if key in given})
    if not all(map(_usable, changed)):
        return {}
    return {key: value for key, value in zip(BODY, changed, strict=True) if key not in given}


def _value(content: Mapping[str, Any], key: str) -> Any:
    section, _, name = key.partition('.')
    group = content.get(section)
    return group.get(name) if isinstance(group, Mapping) else None


def _usable(value: Any) -> bool:
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return number and 0.0 < value < math.inf
