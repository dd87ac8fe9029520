# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A scenario as files: one with its car and drive in it, or one for each."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ddct_plant.base.clutch_kinds import LINEAR
from ddct_plant.files.input_file import SCHEMA_KEY
from ddct_plant.files.yaml_text import dump_yaml
from ddct_plant.scenario.nouns.keys import CAR, DRIVE, NOUNS, SCENARIO, by_noun
from ddct_plant.scenario.nouns.part import BASE, DESCRIPTION, Part, Text
from ddct_plant.scenario.nouns.scenario_text import SCHEMA_VERSION


def whole_text(content: Mapping[str, Any]) -> str:
    """Return the text of a scenario file with its car and drive in it."""
    parts = by_noun(content)
    return dump_yaml({**_own(content), CAR: parts[CAR], DRIVE: parts[DRIVE]})


def texts_by_file(content: Mapping[str, Any], target: Path) -> dict[Path, str]:
    """
    Return the text of each file by its path: the scenario at `target`, its car and drive beside.

    The car has a packaged base, and the values that differ from those of the base.
    """
    parts, own = by_noun({'clutch': LINEAR, **content}), _own(content)
    found: dict[Path, str] = {}
    for noun, path in beside(target).items():
        part = parts[noun]
        if noun == CAR:
            base = _base(part)
            part = {BASE: base, **_different(part, Part.read(Text(CAR, base)).content)}
        if noun == DRIVE and DESCRIPTION in own:
            part = {DESCRIPTION: own.pop(DESCRIPTION), **part}
        own[noun] = path.name
        found[path] = dump_yaml(part)
    return {target: dump_yaml(own), **found}


def beside(target: Path) -> dict[str, Path]:
    """Return the paths of the car and the drive of a scenario that is written at `target`."""
    return {noun: target.with_name(f'{target.stem}_{noun}.yaml') for noun in NOUNS}


def _own(content: Mapping[str, Any]) -> dict[str, Any]:
    """Return the keys of the scenario file itself, without empty ones."""
    own = by_noun(content)[SCENARIO]
    given = {name: value for name, value in own.items() if value not in ({}, [], '')}
    return {SCHEMA_KEY: SCHEMA_VERSION, **given}


def _base(car: Mapping[str, Any]) -> str:
    """Return the name of the packaged car that has the engine and the clutch of a car."""
    if car.get('engine_limits') is not None:
        return 'c635'
    return 'c635_thesis' if car['clutch'] == LINEAR else 'c635_no_limits'


def _different(own: Mapping[str, Any], base: Mapping[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in own.items():
        before = base.get(name)
        if isinstance(value, Mapping) and value and isinstance(before, Mapping):
            if changed := _different(value, before):
                found[name] = changed
        elif value != before:
            found[name] = value
    return found
