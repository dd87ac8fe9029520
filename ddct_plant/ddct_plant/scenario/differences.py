# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Differences between a scenario and the packaged scenario of the same name."""

from collections.abc import Sequence
from functools import cache
from typing import Any

from ddct_plant.scenario.choices.scenarios import scenario_names
from ddct_plant.scenario.content import flat, scenario_content
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.key_names import scenario_options
from ddct_plant.scenario.scenario import Scenario

SHOWN = 6
"""Largest number of changed values in a title; the others are counted."""
_LONGEST = 40
_NOT_COMPARED = ('name', 'description', 'adjusted')


def changed_values(scenario: Scenario) -> tuple[str, ...]:
    """
    Return `KEY=VALUE` of every value that differs from the packaged scenario of the same name.

    A scenario whose name is not packaged has none.
    """
    if scenario.name not in scenario_names():
        return ()
    values, packaged = values_by_key(scenario), _packaged_values(scenario.name)
    keys = [*values, *(key for key in packaged if key not in values)]
    before = _packaged_defaults(scenario.name) | packaged
    now = _unwritten_defaults(scenario) | values
    return tuple(
        f'{key}={_text(now[key])}' if key in now else f'{key} left out'
        for key in keys
        if key not in _NOT_COMPARED and now.get(key) != before.get(key)
    )


def scenario_title(name: str, changes: Sequence[str]) -> str:
    """Return a heading: the scenario's name, and its changed values."""
    if not changes:
        return name
    count = f'{len(changes)} value{"s" if len(changes) > 1 else ""} changed'
    more = len(changes) - SHOWN
    shown = ', '.join(changes[:SHOWN]) + (f' and {more} more' if more > 0 else '')
    return f'{name}, {count}: {shown}'


def values_by_key(scenario: Scenario) -> dict[str, object]:
    """Return the values of a scenario by dotted key."""
    return flat(scenario_content(scenario))


@cache
def _packaged_values(name: str) -> dict[str, object]:
    return values_by_key(load_scenario(name))


@cache
def _packaged_defaults(name: str) -> dict[str, object]:
    return _unwritten_defaults(load_scenario(name))


def _unwritten_defaults(scenario: Scenario) -> dict[str, object]:
    """Return the defaults of the sections that a scenario has; its file may not have them."""
    return {
        key: option.default
        for key, option in scenario_options().items()
        if getattr(scenario, key.partition('.')[0]) is not None
    }


def _text(value: Any) -> str:
    text = str(value)
    return text if len(text) <= _LONGEST else f'{text[:_LONGEST]}...'
