# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Where the values of a new car are from: the log, or the files of the car that it starts from."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from ddct_bringup.identification.from_log.result import LogFit
from ddct_plant.models.body import BODY
from ddct_plant.scenario.content import flat
from ddct_plant.scenario.nouns.part import BASE, DESCRIPTION, Part, Text

_LINE = ': line '


def origins(own: Mapping[str, Any], base: Text, fit: LogFit) -> list[str]:
    """
    Return a sentence for each source of the values of a car file `own` above its base.

    Keys that no file gives have their defaults, and are not listed.
    """
    ours = {key for key in flat(own) if key not in (BASE, DESCRIPTION)}
    found = [f'from the log or --set: {", ".join(sorted(ours))}']
    if weak := [f'driveline.{name}' for name in fit.undetermined if name in fit.values]:
        found.append(f'not determined by the log: {", ".join(weak)}')
    return [*found, *_of_files(ours, base)]


def _of_files(ours: set[str], base: Text) -> Iterator[str]:
    """Yield what each file gives of the car, as whole sections where it gives all of one."""
    part = Part.read(base)
    by_file: dict[str, list[str]] = {}
    files_of: dict[str, set[str]] = {}
    for key in flat(part.content):
        file = _file_of(key, part.places)
        if file is None or key in BODY or key in ours:
            continue
        by_file.setdefault(file, []).append(key)
        files_of.setdefault(key.partition('.')[0], set()).add(file)
    sections_of_ours = {key.partition('.')[0] for key in ours}
    for file, keys in by_file.items():
        whole = [
            section
            for section, files in files_of.items()
            if files == {file} and section not in sections_of_ours
        ]
        parts = [key for key in keys if key.partition('.')[0] not in whole]
        yield f'from {file}: {", ".join(sorted([*whole, *parts]))}'


def _file_of(key: str, places: Mapping[str, str]) -> str | None:
    """Return the file that gives a key or its section, None for a default."""
    while key not in places:
        key, point, _ = key.rpartition('.')
        if not point:
            return None
    return places[key].partition(_LINE)[0]


def commented(sentences: Sequence[str]) -> str:
    """Return sentences as comment lines of YAML."""
    return ''.join(f'# {each[0].upper()}{each[1:]}.\n' for each in sentences)
