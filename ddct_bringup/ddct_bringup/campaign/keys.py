# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Keys that a campaign can vary: scenario keys, and the settings of a run."""

from dataclasses import fields
from functools import cache

from ddct_controllers.registry import controller_names, controller_spec
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import Option, Options, group_of, key_of
from ddct_plant.scenario.choices.scenarios import CHOICES, DEFAULT_CAR, DEFAULT_SCENARIO
from ddct_plant.scenario.choices.settings import SETTINGS
from ddct_plant.scenario.csv_profiles import FACTOR, FACTOR_OPTION
from ddct_plant.scenario.key_names import key_hint, scenario_options
from ddct_plant.scenario.scenario import Scenario

SCENARIO, MODE, CONTROLLERS = 'scenario', 'mode', 'controllers'
COMMON = (*CHOICES, 'architecture')
"""Keys that are given for all runs, or varied."""
_CHOICES = {
    name: Option('', f'name of a {name}, or its file', otherwise=otherwise)
    for name, otherwise in zip(
        CHOICES,
        (DEFAULT_SCENARIO, f'that of the scenario, or {DEFAULT_CAR}', 'that of the scenario'),
        strict=True,
    )
}
HANDOVER = 'handover'
"""Key of the handover of a gear shift, by its name or the file of its code."""
FILE_KEY = '.csv'
"""Suffix of the key of a file with a profile."""


@cache
def run_options() -> Options:
    """Return the settings that can vary, without the mode: a campaign has no wall clock."""
    return {name: each for name, each in SETTINGS.items() if name != MODE}


def option_of(where: str, key: str) -> Option | None:
    """
    Return the option of a key, None where only the scenario or a controller defines it.

    Raise ParameterError, which begins with `where`, for an unknown key.
    """
    known = {**_CHOICES, **run_options(), **scenario_options()}
    if key in known:
        return known[key]
    section, _, rest = key.partition('.')
    if section == CONTROLLERS:
        name, _, option = rest.partition('.')
        if name not in controller_names():  # the name of a file or an object, or unknown
            return None
        return (controller_spec(name).options or {}).get(option)
    if rest == FACTOR and section in sections():
        return FACTOR_OPTION
    if key in sections() or key.removesuffix(FILE_KEY) in sections():
        return None
    raise ParameterError(f'{where}: unknown key {key}: {key_hint(key, known)}', key=key)


@cache
def sections() -> frozenset[str]:
    """Return the names of the groups of keys that a scenario has."""
    return frozenset(key_of(field) for field in fields(Scenario) if group_of(field))
