# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The case of a run: values that its plant alone has, by key, as options and files give them."""

import difflib
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.base.options import options_of
from ddct_plant.files.input_file import located, user_text
from ddct_plant.files.yaml_text import parse_yaml_with_lines
from ddct_plant.scenario.choices.scenarios import Choice
from ddct_plant.scenario.choices.settings import SETTINGS
from ddct_plant.scenario.content import flat, scenario_content
from ddct_plant.scenario.file import ScenarioFile
from ddct_plant.scenario.key_names import scenario_options
from ddct_plant.scenario.nouns.places import Places
from ddct_plant.scenario.overrides import parsed_override
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

OF_CASE = tuple(options_of(CaseSettings))
"""Keys of a case that are no keys of a scenario: wear gains and seed."""
_NOT_OF_PLANT = 'the plant does not use it'
_FITTING = 'controllers must know it to fit the run'
_ALWAYS_KNOWN = {
    **dict.fromkeys(name for name in SETTINGS if name not in OF_CASE),
    **dict.fromkeys(('name', 'description', 'duration_s', 'control_start_s'), _NOT_OF_PLANT),
    **dict.fromkeys(('score_window_s', 'pedal_position', 'controllers'), _NOT_OF_PLANT),
    **dict.fromkeys(('reference', 'slip_reference', 'closing'), _NOT_OF_PLANT),
    'engine_speed_reference': _NOT_OF_PLANT,
    **dict.fromkeys(('clutch', 'gear', 'shift'), _FITTING),
}
"""Why a key, or a section, is no part of a case; settings of the program have no reason here."""
_KEY_AND_VALUE = re.compile(r'[\w.]+=')


def is_always_known(key: str) -> bool:
    """Return whether a key is known wherever it is given, so that no case has it."""
    return key.partition('.')[0] in _ALWAYS_KNOWN


def case_values(given: Iterable[str]) -> dict[str, Any]:
    """
    Return the values by dotted key of texts that are KEY=VALUE or the path of a YAML file.

    The last value of a key counts. Raise DdctError for other text, or a file that has no keys.
    """
    values: dict[str, Any] = {}
    for text in given:
        if _KEY_AND_VALUE.match(text):
            key, value = parsed_override(text, '--case')
            values[key] = value
        else:
            values |= case_of_file(text)
    return values


def case_of_file(file: str) -> dict[str, Any]:
    """Return the values by dotted key of a YAML file; raise DdctError that names the file."""
    with located(f'case {file}'):
        content, _ = parse_yaml_with_lines(user_text(Path(file)))
        if not isinstance(content, Mapping):
            raise DdctError('give keys and values, such as `vehicle.mass_kg: 1700`')
        return flat(content)


@dataclass(frozen=True)
class CaseOf:
    """Cases of runs that have the same known settings."""

    known: Scenario
    """Scenario that controllers know."""
    file: ScenarioFile
    """Its content, which a case overrides."""

    @classmethod
    def of(cls, known: Scenario) -> Self:
        """Return the cases of a scenario whose values are given as they are."""
        places = Places(f'scenario {known.name}')
        return cls(known, ScenarioFile(Choice(known.name), scenario_content(known), places=places))

    def scenario(self, overrides: Mapping[str, Any]) -> Scenario | None:
        """
        Return the known scenario with overrides by dotted key; None where nothing differs.

        Values that depend on others follow as with `--set`: an unknown mass moves the inertia.
        """
        if not overrides:
            return None
        true = self.file.scenario(overrides)
        return None if true == self.known else true


def require_spelt(keys: Iterable[str]) -> None:
    """Raise ParameterError for a key that is nearly one of OF_CASE."""
    for key in keys:
        if '.' in key or key in SETTINGS or key in scenario_options():
            continue
        if close := difflib.get_close_matches(key, OF_CASE, n=1, cutoff=0.8):
            raise ParameterError(f'unknown key {key}: did you mean {close[0]}?', key=key)


def require_of_case(keys: Iterable[str]) -> None:
    """Raise ParameterError for a key that controllers know in any run, or that is misspelt."""
    keys = [*keys]
    require_spelt(keys)
    for key in keys:
        section = key.partition('.')[0]
        if section not in _ALWAYS_KNOWN:
            continue
        option, reason = '--set', _ALWAYS_KNOWN[section]
        if reason is None:
            option, reason = f'--{section.replace("_", "-")}', _FITTING
        raise ParameterError(
            f'{key} cannot be in a case, as {reason}: give it by {option}', key=key
        )


def with_case(known: KnownSettings, values: Mapping[str, Any]) -> RunSettings:
    """
    Return the true settings of a run: the known ones, and the case of these values by dotted key.

    Raise DdctError for an unknown key, a bad value, or a key that controllers know in any run.
    """
    with located('case'):
        require_of_case(values)
        own = {key: values[key] for key in values if key in OF_CASE}
        overrides = {key: values[key] for key in values if key not in OF_CASE}
        scenario = CaseOf.of(known.scenario).scenario(overrides)
        return RunSettings(known, CaseSettings(**own, scenario=scenario))
