# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A scenario from the content of a file, nested mappings, and back."""

import dataclasses
from collections.abc import Mapping
from typing import Any

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import Group, OptionGroup, group_of, key_of
from ddct_plant.models.parameters import DrivelineSection, VehicleParameters
from ddct_plant.scenario.key_names import scenario_key_hint
from ddct_plant.scenario.scenario import Scenario


def scenario_from_mapping(content: Mapping[str, Any]) -> Scenario:
    """Return the scenario of nested mappings, as `scenario_content` returns them."""
    content = {'description': '', **content}
    content['controllers'] = _gains(content.get('controllers') or {})
    scenario = _build(Scenario, content)
    section = without_derived(scenario.given_driveline, scenario.vehicle)
    if section is scenario.given_driveline:
        return scenario
    return dataclasses.replace(scenario, given_driveline=section)


def without_derived(section: DrivelineSection, vehicle: VehicleParameters) -> DrivelineSection:
    """Return the section without a J_v that is that of mass and radius to the last bit."""
    if section.vehicle_inertia != vehicle.inertia:
        return section
    return dataclasses.replace(section, vehicle_inertia=None)


def flat(content: Any, key: str = '') -> dict[str, Any]:
    """Return every value within `content`, which is at `key`, by its dotted key."""
    if not isinstance(content, Mapping):
        return {key: content}
    values: dict[str, Any] = {}
    for name, value in content.items():
        values |= flat(value, f'{key}.{name}' if key else str(name))
    return values


def _build(group: type[Group], content: Any) -> Group:
    prefix = group.prefix
    if not isinstance(content, Mapping):
        raise ParameterError(
            f'{prefix.rstrip(".")}: give keys and values, not {content!r}', key=prefix.rstrip('.')
        )
    fields = {key_of(field): field for field in dataclasses.fields(group)}
    for name in content:
        if name not in fields:
            hint = scenario_key_hint(str(name), fields, prefix)
            raise ParameterError(f'unknown key {prefix}{name}: {hint}', key=f'{prefix}{name}')
    for name, field in fields.items():
        required = (
            field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING
        )
        if required and name not in content:
            raise ParameterError(f'key {prefix}{name} is missing', key=f'{prefix}{name}')
    values = {fields[key].name: _value(fields[key], value) for key, value in content.items()}
    return group(**values)


def _value(field: dataclasses.Field[Any], value: Any) -> Any:
    """Convert a YAML value to the type of the field: a group, a tuple, a whole number."""
    group = group_of(field)
    if group and (value is not None or field.default is not None):
        return _build(group, value)
    described = field.metadata.get('option')
    if described and described.many and isinstance(value, list):
        return tuple(value)
    whole = described and described.kind is int and isinstance(value, float)
    return int(value) if whole and value.is_integer() else value


def _gains(content: Any) -> dict[str, dict[str, Any]]:
    if not isinstance(content, Mapping) or not all(
        isinstance(gains, Mapping) for gains in content.values()
    ):
        raise ParameterError(
            'controllers: give gains by controller name, {pi: {...}}', key='controllers'
        )
    return {str(name): dict(gains) for name, gains in content.items()}


def scenario_content(scenario: Scenario) -> dict[str, Any]:
    """
    Return the content of the scenario, without optional keys at their defaults.

    The section `driveline` has every value that models take, given or derived.
    """
    return _content(scenario) | {'driveline': _content(DrivelineSection.of(scenario.driveline))}


def _content(group: OptionGroup) -> dict[str, Any]:
    content: dict[str, Any] = {}
    for field in dataclasses.fields(group):
        value = getattr(group, field.name)
        if value is None or (field.metadata.get('left_out') and value == field.default):
            continue
        nested = isinstance(value, OptionGroup)
        content[key_of(field)] = _content(value) if nested else _plain(value)
    return content


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items() if item is not None}
    return [_plain(item) for item in value] if isinstance(value, tuple) else value
