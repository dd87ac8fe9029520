# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Read, change and write scenarios as YAML; every unknown key and bad value is named."""

import dataclasses
import hashlib
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from ddct_plant.base.clutch_kinds import LINEAR
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.files.input_file import SCHEMA_KEY, located, user_text
from ddct_plant.files.yaml_text import dump_yaml, parse_yaml_with_lines
from ddct_plant.scenario.choices.scenarios import packaged_scenarios, scenario_names
from ddct_plant.scenario.content import SCHEMA_VERSION, flat, scenario_content, scenario_of
from ddct_plant.scenario.csv_profiles import with_points
from ddct_plant.scenario.overrides import (
    is_number_of,
    lines_in_file,
    parsed_override,
    put,
    time_or_none,
    with_numbers,
)
from ddct_plant.scenario.rules.consistency import FILE, SET, consistent
from ddct_plant.scenario.rules.driveline import require_driveline
from ddct_plant.scenario.rules.plausible import with_remarks
from ddct_plant.scenario.scenario import Scenario


@dataclass(frozen=True)
class ScenarioFile:
    """Content of a scenario file, from which scenarios with overrides are made."""

    name: str
    """Name or path of the scenario, as requested."""
    content: Mapping[str, Any]
    """Values of the file by key, nested."""
    lines: Mapping[str, int]
    """Line numbers of the keys and items, by path."""
    _starts: dict[tuple[str, ...], '_Start'] = dataclasses.field(
        default_factory=dict, init=False, repr=False, compare=False
    )
    """Scenarios with numbers that were set before, by the dotted keys of these numbers."""

    @classmethod
    def read(cls, name_or_file: str) -> 'ScenarioFile':
        """Read a scenario; raise the errors of `load_scenario`."""
        text, default_name = _read(name_or_file)
        with located(f'scenario {name_or_file}'):
            content, lines = parse_yaml_with_lines(text)
            if not isinstance(content, dict):
                raise DdctError('the file must be a mapping of keys to values')
        content.setdefault('name', default_name)
        return cls(name_or_file, content, lines)

    def scenario(
        self, overrides: Iterable[str] | Mapping[str, Any] = (), clutch: str = LINEAR
    ) -> Scenario:
        """Return the scenario with overrides; arguments and errors as in `load_scenario`."""
        pairs = [
            *(
                overrides.items()
                if isinstance(overrides, Mapping)
                else map(parsed_override, overrides)
            )
        ]
        keys = tuple(key for key, _ in pairs)
        numbers = all(type(value) is float for _, value in pairs)
        start = self._starts.get(keys) if numbers else None
        if start is None:
            start = self._start(pairs)
            if numbers and all(is_number_of(start.scenario, key) for key in keys):
                self._starts[keys] = start
            scenario = start.scenario
        with located(f'scenario {self.name}', start.lines):
            if start is self._starts.get(keys):
                scenario = with_numbers(start.scenario, pairs)
            scenario = with_remarks(consistent(scenario, start.origins, self._control_start))
            require_driveline(scenario.driveline, clutch)
            return scenario

    def _start(self, pairs: Sequence[tuple[str, Any]]) -> '_Start':
        """Return the scenario with values by dotted key, from the content of the file."""
        content = dict(self.content)
        set_keys = [leaf for key, value in pairs for leaf in put(content, key, value)]
        lines = lines_in_file(self.lines, set_keys)
        with located(f'scenario {self.name}', lines):
            content = with_points(content, Path(self.name).parent, set_keys)
            scenario = scenario_of(content)
        origins = dict.fromkeys(flat(content), FILE) | dict.fromkeys(set_keys, SET)
        return _Start(scenario, origins, lines)

    @cached_property
    def _control_start(self) -> float | None:
        """Time in s at which control starts in the file, None if it is missing or wrong."""
        return time_or_none(self.content.get('control_start_s'))


@dataclass(frozen=True)
class _Start:
    """A scenario with overrides, before dependent values follow from them."""

    scenario: Scenario
    origins: Mapping[str, int]
    """Origin of each given value by dotted key."""
    lines: Mapping[str, int]
    """Line numbers of the keys that are in the file, by path."""


def load_scenario(
    name_or_file: str,
    overrides: Iterable[str] | Mapping[str, Any] = (),
    clutch: str = LINEAR,
) -> Scenario:
    """
    Return the scenario that a name or a YAML file describes, with overrides.

    Overrides are texts `KEY=VALUE`, or values by dotted key. `clutch` is the clutch model of the
    run: not every driveline can be integrated with a stick-slip clutch.

    Dependent values are kept consistent (see `consistency`), and values that no car has get a
    line in `adjusted` (see `plausible`).
    Raise ParameterError for an unknown scenario or key or a bad value, DdctError for a file that
    cannot be read.
    """
    return ScenarioFile.read(name_or_file).scenario(overrides, clutch)


def is_packaged(name_or_file: str) -> bool:
    """Return whether it is the name of a packaged scenario rather than a file."""
    return '/' not in name_or_file and not name_or_file.endswith(('.yaml', '.yml'))


def scenario_to_yaml(scenario: Scenario) -> str:
    """Return the YAML text that `load_scenario` reads back to an equal scenario."""
    return dump_yaml({SCHEMA_KEY: SCHEMA_VERSION, **scenario_content(scenario)})


def scenario_digest(scenario: Scenario) -> str:
    """
    Return a short hash over every value of the scenario, to distinguish two of one name.

    Optional keys count only where they are given, so that the hash of a scenario stays when the
    schema gets a new key.
    """
    text = json.dumps(scenario_content(scenario), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _read(name_or_file: str) -> tuple[str, str]:
    if not name_or_file:
        raise ParameterError('scenario is empty: give a name or a YAML file', key='scenario')
    if is_packaged(name_or_file):
        if name_or_file not in scenario_names():
            raise ParameterError(
                f'unknown scenario {name_or_file!r}: choose from {", ".join(scenario_names())}, '
                'or give the path of a YAML file',
                key=name_or_file,
            )
        resource = packaged_scenarios() / f'{name_or_file}.yaml'
        return resource.read_text(encoding='utf-8'), name_or_file
    path = Path(name_or_file)
    with located(f'scenario {path}'):
        return user_text(path), path.stem
