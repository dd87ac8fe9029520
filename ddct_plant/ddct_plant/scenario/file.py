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

from ddct_plant.models.body import BODY
from ddct_plant.scenario.choices.scenarios import Choice
from ddct_plant.scenario.content import scenario_content, scenario_from_mapping
from ddct_plant.scenario.csv_profiles import described_profiles, with_points
from ddct_plant.scenario.nouns.composed import composed
from ddct_plant.scenario.nouns.places import Places
from ddct_plant.scenario.nouns.written import whole_text
from ddct_plant.scenario.overrides import (
    is_number_of,
    parsed_override,
    put,
    with_changes,
    with_numbers,
)
from ddct_plant.scenario.rules.body import derived
from ddct_plant.scenario.rules.driveline import require_driveline
from ddct_plant.scenario.rules.plausible import with_remarks
from ddct_plant.scenario.scenario import Scenario


@dataclass(frozen=True)
class ScenarioFile:
    """A car, a drive and changed keys, from which scenarios with overrides are made."""

    choice: Choice
    """What was requested."""
    content: Mapping[str, Any]
    """Values of the scenario by key, nested, before `set`."""
    set: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    """Values by dotted key in place of those of car and drive, as `--set` gives them."""
    places: Places = Places('scenario')
    """Files and lines of the keys."""
    files: tuple[Path, ...] = ()
    """Files of the user that it is made of."""
    _starts: dict[tuple[str, ...], '_Start'] = dataclasses.field(
        default_factory=dict, init=False, repr=False, compare=False
    )
    """Scenarios with numbers that were set before, by the dotted keys of these numbers."""

    @classmethod
    def read(cls, choice: Choice | str) -> 'ScenarioFile':
        """Read what is chosen, or the scenario of a name or file; errors of `load_scenario`."""
        choice = Choice(choice) if isinstance(choice, str) else choice
        made = composed(choice)
        return cls(choice, made.content, made.set, made.places, made.files)

    def scenario(self, overrides: Iterable[str] | Mapping[str, Any] = ()) -> Scenario:
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
        with start.places.located():
            if start is self._starts.get(keys):
                given = dict(pairs)
                if any(key in given for key in BODY):
                    given |= derived(self._changed[0], given)
                scenario = with_numbers(start.scenario, given)
            scenario = with_remarks(scenario)
            require_driveline(scenario.driveline, scenario.clutch)
            return scenario

    def of_cases(self, known: Scenario, changes: Mapping[str, Any]) -> 'ScenarioFile':
        """
        Return a file with the content of `known`, the scenario that this one gives with `changes`.

        Overrides of it are those of a case. Profiles that a CSV file or a factor describes stay
        described, so that another file or factor takes their place.
        """
        content, given = dict(self.content), {**self.set, **changes}
        set_keys = [leaf for key, value in given.items() for leaf in put(content, key, value)]
        described = described_profiles(content, set_keys)
        places = Places(self.places.otherwise)
        return ScenarioFile(self.choice, {**scenario_content(known), **described}, places=places)

    def _start(self, pairs: Sequence[tuple[str, Any]]) -> '_Start':
        """Return the scenario with values by dotted key, from the content of the files."""
        changed, of_file = self._changed
        content, set_keys = with_changes(changed, pairs)
        places = self.places.with_set(set_keys)
        with places.located():
            content = with_points(content, [*of_file, *set_keys])
            return _Start(scenario_from_mapping(content), places)

    @cached_property
    def _changed(self) -> tuple[Mapping[str, Any], list[str]]:
        """The content with the changed keys of the file, and these keys."""
        return with_changes(self.content, self.set.items())


@dataclass(frozen=True)
class _Start:
    """A scenario with overrides."""

    scenario: Scenario
    places: Places
    """Files and lines of the keys."""


def load_scenario(
    scenario: str | None = None,
    overrides: Iterable[str] | Mapping[str, Any] = (),
    *,
    car: str | None = None,
    drive: str | None = None,
) -> Scenario:
    """
    Return the scenario of a name or a YAML file, with another car or drive, and overrides.

    The scenario, car and drive are those of a `Choice`. Overrides are texts `KEY=VALUE`, or values
    by dotted key.

    Of mass, wheel radius and inertia of the vehicle what is not given follows (see `Body`).
    Values that no car has get a line in `adjusted` (see `plausible`).
    Raise ParameterError for an unknown name or key or a bad value, DdctError for a file that
    cannot be read.
    """
    return ScenarioFile.read(Choice(scenario, car, drive)).scenario(overrides)


def scenario_to_yaml(scenario: Scenario) -> str:
    """Return the YAML text, with car and drive in it, that `load_scenario` reads back as equal."""
    return whole_text(scenario_content(scenario))


def scenario_digest(scenario: Scenario) -> str:
    """
    Return a short hash over every value of the scenario, to distinguish two of one name.

    Optional keys count only where they are given, so that the hash of a scenario stays when the
    schema gets a new key.
    """
    text = json.dumps(scenario_content(scenario), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]
