# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A car or a drive: a YAML file, a packaged name, or a section of a scenario file."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Self

from ddct_plant.base.errors import DdctError, ParameterError, choices_hint
from ddct_plant.files.input_file import (
    SCHEMA_KEY,
    located,
    named_in,
    require_schema_version,
    user_text,
)
from ddct_plant.files.yaml_text import parse_yaml_with_lines
from ddct_plant.models.body import BODY
from ddct_plant.scenario.choices.scenarios import (
    DEFAULT_CAR,
    is_packaged,
    packaged_names,
    packaged_text,
)
from ddct_plant.scenario.content import flat
from ddct_plant.scenario.csv_profiles import SECTIONS as PROFILES
from ddct_plant.scenario.csv_profiles import file_of, with_file_in
from ddct_plant.scenario.nouns.keys import CAR, require_keys_of
from ddct_plant.scenario.nouns.layers import layered
from ddct_plant.scenario.nouns.places import Places, places_of
from ddct_plant.scenario.rules.body import with_body

SCHEMA_VERSION = 1
"""Version of the keys of a car or drive file; a file without a version has this one."""
BASE, DESCRIPTION = 'base', 'description'


@dataclass(frozen=True)
class Text:
    """Text of a YAML file that a user or the package has, by its name or path."""

    noun: str
    """What the file describes: a car, a drive or a scenario."""
    name: str
    """Packaged name, or path, as it was requested and relative to the working directory."""

    @property
    def label(self) -> str:
        """Return what errors call the file."""
        return f'{self.noun} {self.name}'

    @property
    def path(self) -> Path | None:
        """Return the path of a user's file, None for a packaged name."""
        return None if is_packaged(self.name) else Path(self.name)

    @property
    def stem(self) -> str:
        """Return the name of the file, without folder and ending."""
        return self.path.stem if self.path else self.name

    @property
    def folder(self) -> Path:
        """Return the folder that the files which it names are relative to."""
        return self.path.parent if self.path else Path()

    def beside(self, noun: str, name: object) -> 'Text':
        """Return a file that this one names, of a noun; raise ParameterError for no name."""
        if not isinstance(name, str) or not name:
            raise ParameterError(f'{noun} is {name!r}: give a name or a YAML file', key=noun)
        return Text(noun, name if is_packaged(name) else str(named_in(self.folder, name)))

    def content(self) -> tuple[Mapping[str, Any], Mapping[str, int]]:
        """Return keys and values, and the lines of the keys; raise DdctError that names it."""
        return _parsed(self) if self.path else _packaged(self)

    def read(self) -> str:
        """Return the text itself; raise DdctError where there is none."""
        if not self.name:
            raise ParameterError(
                f'{self.noun} is empty: give a name or a YAML file', key=self.noun
            )
        if self.path:
            with located(self.label):
                return user_text(self.path)
        names = packaged_names(self.noun)
        if self.name not in names:
            raise ParameterError(
                f'unknown {self.noun} {self.name!r}: {choices_hint(self.name, names)}, or '
                'give the path of a YAML file',
                key=self.name,
            )
        return packaged_text(self.noun, self.name)


def _parsed(file: Text) -> tuple[Mapping[str, Any], Mapping[str, int]]:
    text = file.read()
    with located(file.label):
        content, lines = parse_yaml_with_lines(text)
        if not isinstance(content, dict):
            raise DdctError('the file must be a mapping of keys to values')
    return content, lines


_packaged = cache(_parsed)
"""The same of a file of the package, which does not change."""


@dataclass(frozen=True)
class Part:
    """A car or a drive with the values of its bases."""

    label: str
    """What errors call it."""
    content: Mapping[str, Any]
    """Values by key, nested, each of the noun."""
    description: str
    places: Mapping[str, str]
    """Files and lines of the keys, by path."""
    files: tuple[Path, ...]
    """Files of the user that it is made of: its own, its bases and their profiles."""

    @classmethod
    def read(cls, text: Text, above: tuple[str, ...] = ()) -> Self:
        """
        Return the car or drive in a file, with the values of its bases below its own.

        `above` are the files that have it as a base. Raise DdctError that names file and line,
        also for a car without a base that is not whole.
        """
        if text.name in above:
            circle = ' -> '.join((*above, text.name))
            raise ParameterError(f'the files are bases of one another: {circle}', key=BASE)
        content, lines = text.content()
        places = places_of(text.label, lines)
        files = (text.path,) if text.path else ()
        part = cls.of(text, content, places, (*above, text.name), files)
        if text.noun == CAR and content.get(BASE) is None:
            with located(text.label):
                _require_whole(content)
        return part

    @classmethod
    def of(
        cls,
        text: Text,
        content: Mapping[str, Any],
        places: Places,
        above: tuple[str, ...] = (),
        files: tuple[Path, ...] = (),
    ) -> Self:
        """Return the car or drive of a content; the files that it names are relative to `text`."""
        own = {
            key: with_file_in(text.folder, value) if key in PROFILES else value
            for key, value in content.items()
            if key not in (BASE, DESCRIPTION, SCHEMA_KEY)
        }
        with places.located():
            require_schema_version(content, SCHEMA_VERSION)
            require_keys_of(text.noun, own)
        base = cls('', {}, '', {}, ())
        if content.get(BASE) is not None:
            with located(places.of_keys[BASE]):
                base = cls.read(text.beside(text.noun, content[BASE]), above)
        profiles = (file_of(own.get(name)) for name in PROFILES)
        return cls(
            places.otherwise,
            with_body(layered(base.content, own), base.content, flat(own)),
            content.get(DESCRIPTION) or base.description,
            {**base.places, **places.of_keys},
            (*files, *(each for each in profiles if each), *base.files),
        )


def _require_whole(content: Mapping[str, Any]) -> None:
    """
    Refuse a car without a base that lacks a key which the packaged car gives.

    A section that is off, or that has its defaults, gives all its keys. Two of mass, wheel radius
    and inertia give the third.
    """
    lacking = []
    for section, keys in _keys_of_whole().items():
        if section not in content:
            lacking += [section] if keys else []
        elif content[section]:
            given = flat({section: content[section]})
            lacking += [key for key in keys if key not in given]
    if len({*BODY} & {*flat(content)}) < 2:
        lacking.append(f'two of {", ".join(BODY)}')
    if lacking:
        raise ParameterError(
            f'it has no base and lacks {", ".join(lacking)}: give them, or write '
            f'`{BASE}: {DEFAULT_CAR}` to take what is missing from that car',
            key=BASE,
        )


@cache
def _keys_of_whole() -> dict[str, list[str]]:
    """Return the keys that a whole car gives by section: those of the packaged car."""
    whole, _ = Text(CAR, DEFAULT_CAR).content()
    return {
        section: [key for key in flat({section: value}) if key not in (*BODY, DESCRIPTION)]
        for section, value in whole.items()
    }
