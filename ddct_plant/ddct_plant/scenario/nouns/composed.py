# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What a car, a drive and the changed keys of a scenario file make together."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ddct_plant.scenario.choices.scenarios import DEFAULT_CAR, Choice
from ddct_plant.scenario.nouns.keys import CAR, DRIVE, NOUNS, SCENARIO, owner_of
from ddct_plant.scenario.nouns.part import DESCRIPTION, Part, Text
from ddct_plant.scenario.nouns.places import Places
from ddct_plant.scenario.nouns.scenario_text import NAME, SET, ScenarioText


@dataclass(frozen=True)
class Composed:
    """A car, a drive and changed keys as one content."""

    content: Mapping[str, Any]
    """Values of a scenario by key, nested, before `set`."""
    set: Mapping[str, Any]
    """Changed values by dotted key."""
    places: Places
    files: tuple[Path, ...]
    """Files of the user that it is made of."""


def composed(choice: Choice) -> Composed:
    """
    Return what a scenario makes, with another car or drive where these are chosen.

    What a scenario changes by `set` it changes of another car and drive too. Raise DdctError that
    names file and line.
    """
    given = {noun: Text(noun, choice.given[noun]) for noun in NOUNS if noun in choice.given}
    scenario = choice.whole_scenario
    if scenario is None:
        texts = {CAR: Text(CAR, DEFAULT_CAR), **given}
        name = f'{texts[DRIVE].stem}_{texts[CAR].stem}'
        parts = {noun: Part.read(texts[noun]) for noun in NOUNS}
        places = Places(f'{texts[DRIVE].label} with {texts[CAR].label}')
        return _joined(parts, {NAME: name}, {}, places, ())
    file = ScenarioText.read(scenario)
    parts = {noun: Part.read(given[noun]) if noun in given else file.part(noun) for noun in NOUNS}
    own = {NAME: file.name, **file.own}
    if given:
        drive_name = given[DRIVE].stem if DRIVE in given else file.name
        car_name = given[CAR].stem if CAR in given else file.stem_of(CAR)
        own |= {NAME: f'{drive_name}_{car_name}'}
    files = (file.text.path,) if file.text.path else ()
    return _joined(parts, own, file.set, file.places, files)


def files_of_noun(noun: str, path: str) -> tuple[Path, ...]:
    """Return the file of a scenario, a car or a drive, and the files that it is made of."""
    if noun == SCENARIO:
        return composed(Choice(path)).files
    return Part.read(Text(noun, path)).files


def _joined(
    parts: Mapping[str, Part],
    own: Mapping[str, Any],
    changes: Mapping[str, Any],
    places: Places,
    files: tuple[Path, ...],
) -> Composed:
    """Return the keys of both nouns, and those of the scenario file itself."""
    content = dict(parts[DRIVE].content)
    for name, value in parts[CAR].content.items():
        content[name] = {**value, **content[name]} if name in content else value
    of_set = places.within(SET).of_keys
    of_keys = {
        **{key: at for noun in NOUNS for key, at in parts[noun].places.items()},
        **{key: at for key, at in places.of_keys.items() if owner_of(key) == SCENARIO},
        **{key: of_set[key] for key in of_set if key in changes},
    }
    return Composed(
        content={DESCRIPTION: parts[DRIVE].description, **content, **own},
        set=changes,
        places=Places(
            places.otherwise, of_keys, {noun: part.label for noun, part in parts.items()}
        ),
        files=(*files, *(file for noun in NOUNS for file in parts[noun].files)),
    )
