# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The files and lines in which the keys of a composed scenario stand, for errors."""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field

from ddct_plant.base.errors import DdctError
from ddct_plant.files.input_file import entry_of
from ddct_plant.scenario.nouns.keys import owner_of


@dataclass(frozen=True)
class Places:
    """Where each key stands: a file with its line, by the dotted key."""

    otherwise: str
    """Place of all else, such as the scenario."""
    of_keys: Mapping[str, str] = field(default_factory=dict)
    of_nouns: Mapping[str, str] = field(default_factory=dict)
    """Place of a key that is missing, by its noun."""

    def with_set(self, set_keys: Iterable[str]) -> 'Places':
        """
        Return the places with those of the keys of `--set`, which stand in no file.

        Sections that only `--set` gives have its place too.
        """
        given = tuple(set_keys)
        sections = (section for key in given for section in _sections_of(key))
        within = tuple(f'{key}{mark}' for key in given for mark in '.[')
        kept = {key: at for key, at in self.of_keys.items() if not key.startswith(within)}
        of_keys = {
            **dict.fromkeys(sections, self.otherwise),
            **kept,
            **dict.fromkeys(given, self.otherwise),
        }
        return Places(self.otherwise, of_keys, self.of_nouns)

    def within(self, section: str) -> 'Places':
        """Return the places of the keys below a section, by the rest of the key."""
        prefix = f'{section}.'
        return Places(
            self.otherwise,
            {
                key.removeprefix(prefix): at
                for key, at in self.of_keys.items()
                if key.startswith(prefix)
            },
        )

    @contextmanager
    def located(self) -> Iterator[None]:
        """Prefix each DdctError within by the place of the key that it names."""
        try:
            yield
        except DdctError as error:
            at = entry_of(f'{error.key} {error}', self.of_keys)
            noun = owner_of(error.key) or ''
            raise error.at(at or self.of_nouns.get(noun, self.otherwise)) from error


def _sections_of(key: str) -> list[str]:
    """Return the sections around a dotted key."""
    names = key.split('.')
    return ['.'.join(names[:count]) for count in range(1, len(names))]


def places_of(label: str, lines: Mapping[str, int]) -> Places:
    """Return the places of the keys in one file, by their lines."""
    return Places(label, {key: f'{label}: line {line}' for key, line in lines.items()})
