# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The cases of a benchmark with another car: the scenarios that it can drive, and its ranges."""

from collections.abc import Mapping
from operator import attrgetter
from typing import Any

from ddct_bringup.campaign.keys import SCENARIO
from ddct_bringup.campaign.specification.distributions import HIGH, LOW, STEP, VALUES
from ddct_bringup.campaign.specification.parts import GRID, RANDOM, VARY
from ddct_bringup.run.run_base import RunBase
from ddct_plant.base.clutch_kinds import STICK_SLIP
from ddct_plant.base.errors import DdctError, without_folders
from ddct_plant.scenario.choices.scenarios import Choice
from ddct_plant.scenario.file import ScenarioFile
from ddct_plant.scenario.nouns.keys import CAR, owner_of
from ddct_plant.scenario.scenario import Scenario

_SENSORS = 'sensors'
_SCALED = (LOW, HIGH, 'mode', 'mean', 'std', 'median')
"""Numbers of a distribution in the unit of its key, but for the step."""


def cases_with_car(content: Mapping[str, Any], car: str) -> tuple[dict[str, Any], dict[str, str]]:
    """
    Return a specification of cases with another car, and the scenarios left out with the reasons.

    `car` is a name or a path. The numbers of each drawn key of the car are multiplied by the car's
    own value over that of the scenario's own car; a key whose value is 0 is not drawn, and listed
    values stay. Sensors of the car take the place of those of the specification. Raise DdctError
    for a car that cannot be read, cannot lock its clutch or can drive no scenario.
    """
    drivable, left_out = _drivable(content[GRID][SCENARIO], car)
    name, scenario = next(iter(drivable.items()))
    if scenario.clutch != STICK_SLIP:
        raise DdctError(
            f'car {car} has the clutch {scenario.clutch}, which cannot lock: give it clutch: '
            f'{STICK_SLIP}'
        )
    before = _scenario(name)
    grid = {**content[GRID], SCENARIO: list(drivable)}
    if scenario.sensors is not None:
        grid.pop(_SENSORS, None)
    changed = {**content, CAR: car, GRID: grid}
    if RANDOM in content:
        vary = {
            key: _scaled(described, attrgetter(key)(scenario), attrgetter(key)(before))
            if owner_of(key) == CAR and VALUES not in described
            else described
            for key, described in content[RANDOM][VARY].items()
        }
        drawn = {key: described for key, described in vary.items() if described is not None}
        changed[RANDOM] = {**content[RANDOM], VARY: drawn}
    return changed, left_out


def _drivable(names: list[str], car: str) -> tuple[dict[str, Scenario], dict[str, str]]:
    """Return the scenarios that a car can drive, and the reasons of the others, by name."""
    drivable, left_out = {}, {}
    for name in names:
        file = ScenarioFile.read(Choice(name, car))
        try:
            drivable[name] = RunBase(file, {}, {}, ()).at().known.scenario
        except DdctError as error:
            left_out[name] = without_folders(str(error))
    if not drivable:
        name, reason = next(iter(left_out.items()))
        raise DdctError(f'car {car} can drive no scenario of the benchmark; {name}: {reason}')
    return drivable, left_out


def _scenario(name: str) -> Scenario:
    return ScenarioFile.read(name).scenario()


def _scaled(described: Mapping[str, Any], own: float, before: float) -> dict[str, Any] | None:
    """Return a distribution with its numbers times `own` over `before`, None where that is 0."""
    if not own:
        return None
    found = {name: described[name] * own / before for name in _SCALED if name in described}
    if STEP in described:
        step = described[STEP]
        found = {name: round(value / step) * step for name, value in found.items()}
    return {**described, **found}
