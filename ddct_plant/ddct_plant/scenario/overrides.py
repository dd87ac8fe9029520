# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Overrides of a scenario: texts `KEY=VALUE`, their place in a file's content, changed numbers."""

import dataclasses
from collections.abc import Iterable, Mapping
from typing import Any

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import OptionGroup, key_of, options_of
from ddct_plant.files.input_file import located
from ddct_plant.files.yaml_text import parse_yaml
from ddct_plant.scenario.content import flat, without_derived
from ddct_plant.scenario.rules.body import with_body
from ddct_plant.scenario.scenario import Scenario

_SECTIONS = {key_of(field): field.name for field in dataclasses.fields(Scenario)}
"""Field of a scenario by its key in files."""


def is_number_of(scenario: Scenario, key: str) -> bool:
    """Return whether a dotted key is that of a number in the scenario or in one of its groups."""
    section, _, leaf = key.rpartition('.')
    group = getattr(scenario, _SECTIONS.get(section, ''), None) if section else scenario
    if not isinstance(group, OptionGroup):
        return False
    option = options_of(type(group)).get(leaf)
    return option is not None and option.kind is float and not option.many


def with_numbers(scenario: Scenario, numbers: Mapping[str, float]) -> Scenario:
    """Return the scenario with other numbers by dotted key; only their groups are built anew."""
    groups: dict[str, dict[str, float]] = {}
    for key, value in numbers.items():
        section, _, leaf = key.rpartition('.')
        groups.setdefault(_SECTIONS[section] if section else '', {})[leaf] = value
    changes: dict[str, Any] = groups.pop('', {})
    for name, values in groups.items():
        changes[name] = dataclasses.replace(getattr(scenario, name), **values)
    vehicle = changes.get('vehicle', scenario.vehicle)
    driveline = changes.get('given_driveline', scenario.given_driveline)
    changes['given_driveline'] = without_derived(driveline, vehicle)
    return dataclasses.replace(scenario, **changes)


def parsed_override(override: str, option: str = '--set') -> tuple[str, Any]:
    """
    Return the dotted key and the value of `KEY=VALUE`, given by an `option`.

    Raise ParameterError for other text.
    """
    key, equals, text = override.partition('=')
    if not equals or not key:
        raise ParameterError(
            f'{option} {override}: write KEY=VALUE, for example duration_s=2.0',
        )
    with located(f'{option} {override}'):
        return key, parse_yaml(text)


def with_changes(
    content: Mapping[str, Any], pairs: Iterable[tuple[str, Any]]
) -> tuple[dict[str, Any], list[str]]:
    """
    Return a nested content with values by dotted key, and the dotted keys of these values.

    Mass, wheel radius and inertia of the vehicle that are not among them follow.
    """
    changed = dict(content)
    keys = [leaf for key, value in pairs for leaf in put(changed, key, value)]
    return with_body(changed, content, keys), keys


def put(content: dict[str, Any], key: str, value: Any) -> list[str]:
    """
    Set one value or group in `content`; return the dotted keys of the given values.

    Every group on the way is copied, because other contents may share it.
    """
    *folders, leaf = key.split('.')
    target = content
    for folder in folders:
        group = target.get(folder, {})
        if not isinstance(group, dict):
            raise ParameterError(f'{key}: {folder} holds a value, not keys', key=key)
        target[folder] = dict(group)
        target = target[folder]
    target[leaf] = value
    return list(flat(value, key))
