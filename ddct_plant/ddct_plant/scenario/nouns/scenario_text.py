# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A scenario file: which car, which drive, and the keys that it changes."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import close_name
from ddct_plant.files.input_file import SCHEMA_KEY, located, named_in, require_schema_version
from ddct_plant.scenario.csv_profiles import FILE_KEY
from ddct_plant.scenario.nouns.keys import (
    CAR,
    DRIVE,
    NOUNS,
    SCENARIO,
    by_noun,
    is_shared,
    owner_of,
)
from ddct_plant.scenario.nouns.part import DESCRIPTION, Part, Text
from ddct_plant.scenario.nouns.places import Places, places_of

SCHEMA_VERSION = 2
"""Version of the keys of a scenario file; a file without a version has this one."""
NAME, SET = 'name', 'set'
KEYS = (SCHEMA_KEY, NAME, DESCRIPTION, CAR, DRIVE, SET, 'controllers', 'adjusted')
CONVERTER = 'tools/run convert_scenario'
"""Command, in a clone, that makes a car, a drive and a scenario of a scenario file of before."""


@dataclass(frozen=True)
class ScenarioText:
    """A scenario file whose car and drive are not read yet."""

    text: Text
    content: Mapping[str, Any]
    places: Places
    set: Mapping[str, Any]
    """Changed values by dotted key."""

    @classmethod
    def read(cls, name_or_file: str) -> Self:
        """Return a scenario by its name or file; raise DdctError that names file and line."""
        text = Text(SCENARIO, name_or_file)
        content, lines = text.content()
        places = places_of(text.label, lines)
        with places.located():
            _require_parts(content)
            changes = _leaves(_mapping(SET, content.get(SET) or {}))
        for key, value in changes.items():
            if key.endswith(FILE_KEY) and isinstance(value, str):
                changes[key] = str(named_in(text.folder, value))
        return cls(text, content, places, changes)

    @property
    def name(self) -> Any:
        """Name of the scenario, by default that of its file."""
        return self.content.get(NAME, self.text.stem)

    @property
    def own(self) -> dict[str, Any]:
        """Values of the keys of a scenario that belong to the file itself."""
        return {key: self.content[key] for key in self.content if owner_of(str(key)) == SCENARIO}

    def stem_of(self, noun: str) -> str:
        """Return the name of the car or the drive; one within the scenario has that of it."""
        given = self.content[noun]
        return self.text.stem if isinstance(given, Mapping) else Text(noun, given).stem

    def part(self, noun: str) -> Part:
        """Return the car or the drive that the scenario names, or has within it."""
        given = self.content[noun]
        if isinstance(given, Mapping):
            return Part.of(Text(noun, self.text.name), given, self.places.within(noun))
        with located(self.places.of_keys[noun]):
            return Part.read(self.text.beside(noun, given))


def _require_parts(content: Mapping[str, Any]) -> None:
    """Refuse a scenario without a car or a drive, and one with keys that belong to them."""
    others = [str(key) for key in content if key not in KEYS]
    moved = {noun: ', '.join(_named(content, noun)) for noun in NOUNS}
    for key in others:
        if not any(moved.values()) or not any(by_noun({key: content[key]}).values()):
            raise ParameterError(f'unknown key {key}: {close_name(key, KEYS)}', key=key)
    if others:
        belongs = ', '.join(f'{keys} to the {noun}' for noun, keys in moved.items() if keys)
        raise ParameterError(
            f'{others[0]}: a scenario names a car and a drive, to which its keys moved: '
            f'{belongs}; {CONVERTER} FILE, in a clone, writes the three files',
            key=others[0],
        )
    require_schema_version(content, SCHEMA_VERSION)
    for noun in NOUNS:
        if content.get(noun) is None:
            raise ParameterError(
                f'key {noun} is missing: give a name, a YAML file, or keys of the {noun}', key=noun
            )


def _named(content: Mapping[str, Any], noun: str) -> list[str]:
    """Return the sections and keys in a content that belong to a noun."""
    part = by_noun({key: value for key, value in content.items() if key not in KEYS})[noun]
    return [
        name
        for section, value in part.items()
        for name in ([f'{section}.{key}' for key in value] if is_shared(section) else [section])
    ]


def _mapping(key: str, value: Any) -> Mapping[str, Any]:
    if not isinstance(value, Mapping):
        raise ParameterError(
            f'{key}: give keys and values, such as {{load.slope_rad: 0.05}}, not {value!r}',
            key=key,
        )
    return value


def _leaves(content: Mapping[str, Any], prefix: str = '') -> dict[str, Any]:
    """Return the values by dotted key; an empty section is a value, which has its defaults."""
    found: dict[str, Any] = {}
    for name, value in content.items():
        key = f'{prefix}{name}'
        inside = isinstance(value, Mapping) and bool(value)
        found |= _leaves(value, f'{key}.') if inside else {key: value}
    return found
