# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The content of a car or a drive: its own values above those of its base."""

from collections.abc import Mapping
from typing import Any

from ddct_plant.scenario.csv_profiles import SECTIONS as PROFILES
from ddct_plant.scenario.csv_profiles import replaced
from ddct_plant.scenario.key_names import scenario_options


def layered(base: Mapping[str, Any], own: Mapping[str, Any], prefix: str = '') -> dict[str, Any]:
    """
    Return the values of `base` with those of `own` in their place, both nested below `prefix`.

    A section that is None is off, whatever the base has, and an empty one has its defaults. A
    list replaces a list.
    """
    found = dict(base)
    for name, value in own.items():
        key, before = f'{prefix}{name}', found.get(name, {})
        if value is None and key not in scenario_options():
            found.pop(name, None)
        elif not isinstance(value, Mapping) or not value:
            found[name] = value
        else:
            if key in PROFILES and isinstance(before, Mapping):
                before = replaced(key, before, value)
            found[name] = layered(before if isinstance(before, Mapping) else {}, value, f'{key}.')
    return found
