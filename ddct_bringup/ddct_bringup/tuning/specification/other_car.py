# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A specification of a tuning in another car: its scenarios, and its ranges."""

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ddct_bringup.benchmark.cases import Cases
from ddct_bringup.benchmark.other_car import cases_with_car
from ddct_bringup.campaign.keys import SCENARIO
from ddct_bringup.campaign.specification.named_files import with_places
from ddct_bringup.campaign.specification.parts import GRID
from ddct_bringup.tuning.specification.development import BENCHMARK, CAMPAIGN, in_folder
from ddct_bringup.tuning.specification.spec import TuningSpec, tuning_spec_of
from ddct_controllers.interface import Controller, ControllerSpec
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.choices.scenarios import is_packaged
from ddct_plant.scenario.nouns.keys import CAR


def in_car(
    spec: TuningSpec, car: str, controller: ControllerSpec[Controller]
) -> tuple[TuningSpec, Mapping[str, str]]:
    """
    Return a specification with another car, by name or file, and the scenarios left out with why.

    What is drawn of the car is drawn around its own values, as in a benchmark. Raise DdctError for
    a car that cannot be used, and for a specification that has one already.
    """
    given = spec.content[CAMPAIGN]
    if CAR in given or CAR in (given.get(GRID) or {}):
        raise ParameterError(
            f'{CAMPAIGN} has a {CAR} already: change that, or leave --car out', key='--car'
        )
    packaged = is_packaged(car)
    folder = spec.folder if packaged else Path(car).absolute().parent
    if BENCHMARK in given:
        left_out: Mapping[str, str] = Cases.packaged(car=car).left_out
        content = dict(given)
    else:
        spec.development.campaign(controller.name, spec.folder)  # so that what follows is valid
        content, left_out = _changed(with_places(given, _absolute(spec.folder)), car)
        content = with_places(content, lambda _, name: os.path.relpath(name, folder))
    content[CAR] = car if packaged else Path(car).name
    found = tuning_spec_of({**spec.content, CAMPAIGN: content}, folder, controller)
    return found, left_out


def _changed(content: Mapping[str, Any], car: str) -> tuple[dict[str, Any], Mapping[str, str]]:
    """Return the cases with another car, in the form that they had, and what is left out."""
    if SCENARIO in (content.get(GRID) or {}):
        return cases_with_car(content, car)
    if SCENARIO not in content:
        raise ParameterError(
            f'{CAMPAIGN} names no {SCENARIO}: give one, or write {CAR} into it, without --car',
            key=f'{CAMPAIGN}.{SCENARIO}',
        )
    in_grid = {**content, GRID: {**(content.get(GRID) or {}), SCENARIO: [content[SCENARIO]]}}
    changed, left_out = cases_with_car(in_grid, car)
    grid = {key: values for key, values in changed[GRID].items() if key != SCENARIO}
    return {**changed, GRID: grid}, left_out


def _absolute(folder: Path) -> Callable[[str, str], str]:
    return lambda _, name: in_folder(folder, name)
