# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The car of a log: what is measured in place of what its base has."""

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ddct_bringup.identification.from_log.drive_of_log import SHAFTS, LogDrive
from ddct_plant.base.errors import DdctError
from ddct_plant.models.body import MASS, RADIUS
from ddct_plant.scenario.choices.scenarios import DEFAULT_CAR, Choice
from ddct_plant.scenario.nouns.composed import composed
from ddct_plant.scenario.nouns.keys import CAR, by_noun
from ddct_plant.scenario.nouns.part import BASE, DESCRIPTION, Text
from ddct_plant.scenario.nouns.scenario_text import ScenarioText
from ddct_plant.scenario.overrides import parsed_override, put


def base_of_car(choice: Choice) -> Text:
    """Return the car that a choice names; raise DdctError for one within a scenario file."""
    if choice.car is not None:
        return Text(CAR, choice.car)
    if choice.whole_scenario is None:
        return Text(CAR, DEFAULT_CAR)
    scenario = ScenarioText.read(choice.whole_scenario)
    named = scenario.content[CAR]
    if isinstance(named, Mapping):
        raise DdctError(
            f'scenario {choice.whole_scenario} has its car within it, and a new car needs a base: '
            'put it into a file of its own, and give that with --car',
            key='--car',
        )
    return scenario.text.beside(CAR, named)


def car_of(
    folder: Path, choice: Choice, overrides: Sequence[str], drive: LogDrive
) -> dict[str, Any]:
    """Return a car file in `folder`: its base, what was set, and what is measured."""
    base, moved = base_of_car(choice), drive.moved
    own: dict[str, Any] = {}
    for key, value in [*composed(choice).set.items(), *map(parsed_override, overrides)]:
        put(own, key, value)
    own = by_noun(own)[CAR]
    own.get('driveline', {}).pop('vehicle_inertia', None)  # it follows from mass and radius
    put(own, MASS, moved.vehicle.mass_kg)
    put(own, RADIUS, moved.vehicle.wheel_radius_m)
    for name in SHAFTS:
        if name in drive.fit.std:
            put(own, f'driveline.{name}', getattr(moved.driveline, name))
    for name, ratios in vars(moved.gearbox).items():
        if ratios != getattr(drive.base.gearbox, name):
            put(own, f'gearbox.{name}', list(ratios))
    within = os.path.realpath(folder)
    named = base.name if base.path is None else os.path.relpath(base.path.resolve(), within)
    return {DESCRIPTION: drive.description, BASE: named, **own}
