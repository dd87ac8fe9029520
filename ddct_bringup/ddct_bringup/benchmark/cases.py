# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Cases of a benchmark: those of development, fixed per release, and those that are held out.

Both are campaigns of one packaged specification. Only their seeds differ.
"""

import hashlib
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from ddct_bringup.benchmark.other_car import cases_with_car
from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.keys import CONTROLLERS
from ddct_bringup.campaign.spec import CampaignSpec, spec_of
from ddct_bringup.campaign.specification.parts import (
    OF,
    RANDOM,
    ROOT_SEED,
    SAMPLES,
)
from ddct_plant.base.errors import ParameterError
from ddct_plant.files.yaml_text import parse_yaml
from ddct_plant.scenario.choices.scenarios import is_packaged
from ddct_plant.scenario.nouns.composed import files_of_noun
from ddct_plant.scenario.nouns.keys import CAR

SPECIFICATION = 'cases.yaml'
QUICK = 10
"""Divisor of the numbers of samples in a quick benchmark."""


def packaged_folder() -> Traversable:
    """Return the folder with the cases of this release, and the rows of its controllers."""
    return files('ddct_bringup.benchmark') / 'packaged'


@dataclass(frozen=True)
class Cases:
    """Specification of the cases, and which part of them runs."""

    content: Mapping[str, Any]
    """
    Specification of a campaign with random samples.

    Its `controllers` run beside the judged one in held-out cases; its `seed` is that of the
    development cases.
    """
    quick: bool = False
    """Whether a tenth of the samples runs, the first ones at each point of the grid."""
    folder: Path = Path()
    """Folder that the file of the car is relative to."""
    left_out: Mapping[str, str] = field(default_factory=dict)
    """Reasons by name of the scenarios that the car cannot drive."""

    @classmethod
    def packaged(cls, *, quick: bool = False, car: str | None = None) -> 'Cases':
        """
        Return the cases of this release, with another car by name or file where one is given.

        Raise DdctError for a car that cannot be read or can drive no scenario.
        """
        text = (packaged_folder() / SPECIFICATION).read_text(encoding='utf-8')
        content = parse_yaml(text)
        if car is None:
            return cls(content, quick)
        content, left_out = cases_with_car(content, car)
        if is_packaged(car):
            return cls(content, quick, left_out=left_out)
        path = Path(car).absolute()
        return cls({**content, CAR: path.name}, quick, path.parent, left_out)

    @property
    def car(self) -> str | None:
        """Name of the car, or its file relative to `folder`; None for those of the scenarios."""
        return self.content.get(CAR)

    @property
    def car_path(self) -> str | None:
        """Name of the car, or the path of its file; None for those of the scenarios."""
        car = self.car
        return car if car is None or is_packaged(car) else str(self.folder / car)

    @property
    def car_files(self) -> tuple[Path, ...]:
        """File of the car, and the files that it is made of; empty for a packaged one."""
        car = self.car_path
        return () if car is None or is_packaged(car) else files_of_noun(CAR, car)

    @property
    def beside(self) -> list[str]:
        """Names of the controllers that run beside the judged one in held-out cases."""
        return list(self.content[CONTROLLERS])

    def with_beside(self, controller: str) -> list[str]:
        """Return a controller and those that run beside it."""
        return [controller, *(each for each in self.beside if each != controller)]

    def require_parts(self) -> None:
        """Raise ParameterError without the parts that campaigns replace."""
        random = self.content.get(RANDOM)
        if not isinstance(self.content.get(CONTROLLERS), list):
            raise ParameterError(f'cases.{CONTROLLERS} is no list', key=CONTROLLERS)
        if not isinstance(random, Mapping) or type(random.get(SAMPLES)) is not int:
            raise ParameterError(f'cases.{RANDOM}.{SAMPLES} is no whole number', key=SAMPLES)
        if type(self.content.get(ROOT_SEED)) is not int:
            raise ParameterError(f'cases.{ROOT_SEED} is no whole number', key=ROOT_SEED)
        if not isinstance(self.content.get(CAR, ''), str):
            raise ParameterError(f'cases.{CAR} is no text', key=CAR)

    @cached_property
    def whole(self) -> CampaignSpec:
        """All development cases, with the controllers that run beside."""
        return spec_of(self.content, self.folder)

    @property
    def digest(self) -> str:
        """SHA-256 of the specification of all cases, and of the files of the car."""
        digest = hashlib.sha256(self.whole.text().encode())
        for path in self.car_files:
            digest.update(path.read_bytes())
        return digest.hexdigest()

    @cached_property
    def planned(self) -> Campaign:
        """Campaign of the development cases that run, with the controllers that run beside."""
        return self.development(self.beside, Path())

    def development(self, controllers: list[str], folder: Path) -> Campaign:
        """Return the campaign of the development cases; files are relative to `folder`."""
        return self._campaign(controllers, folder, self.content[ROOT_SEED])

    def held_out(self, controller: str, folder: Path, seed: int) -> Campaign:
        """Return the campaign of held-out cases, the judged controller first."""
        return self._campaign(self.with_beside(controller), folder, seed)

    def _campaign(self, controllers: list[str], folder: Path, seed: int) -> Campaign:
        content = {**self.content, CONTROLLERS: controllers, ROOT_SEED: seed}
        if self.car_files:
            content[CAR] = os.path.relpath(str(self.car_path), folder)
        if self.quick:
            random = self.content[RANDOM]
            samples = random[SAMPLES]
            content[RANDOM] = {OF: samples, **random, SAMPLES: -(-samples // QUICK)}
        return Campaign(spec_of(content, folder))
