# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Cases of a benchmark: those of development, fixed per release, and those that are held out.

Both are campaigns of one packaged specification. Only their seeds differ.
"""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from ddct_bringup.campaign.campaign import Campaign
from ddct_bringup.campaign.keys import CONTROLLERS
from ddct_bringup.campaign.spec import CampaignSpec, spec_of
from ddct_bringup.campaign.specification.parts import (
    FLOOR_SAMPLES,
    OF,
    RANDOM,
    ROOT_SEED,
    SAMPLES,
)
from ddct_plant.base.errors import ParameterError
from ddct_plant.files.yaml_text import parse_yaml

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
    Specification of a campaign with random samples and floors.

    Its `controllers` run beside the judged one in held-out cases; its `seed` is that of the
    development cases.
    """
    quick: bool = False
    """Whether a tenth of the samples runs, the first ones at each point of the grid."""

    @classmethod
    def packaged(cls, *, quick: bool = False) -> 'Cases':
        """Return the cases of this release."""
        text = (packaged_folder() / SPECIFICATION).read_text(encoding='utf-8')
        return cls(parse_yaml(text), quick)

    @property
    def beside(self) -> list[str]:
        """Names of the controllers that run beside the judged one in held-out cases."""
        return list(self.content[CONTROLLERS])

    def require_parts(self) -> None:
        """Raise ParameterError without the parts that campaigns replace."""
        random = self.content.get(RANDOM)
        if not isinstance(self.content.get(CONTROLLERS), list):
            raise ParameterError(f'cases.{CONTROLLERS} is no list', key=CONTROLLERS)
        if not isinstance(random, Mapping) or type(random.get(SAMPLES)) is not int:
            raise ParameterError(f'cases.{RANDOM}.{SAMPLES} is no whole number', key=SAMPLES)
        if type(self.content.get(ROOT_SEED)) is not int:
            raise ParameterError(f'cases.{ROOT_SEED} is no whole number', key=ROOT_SEED)

    @cached_property
    def whole(self) -> CampaignSpec:
        """All development cases, with the controllers that run beside."""
        return spec_of(self.content, Path())

    @property
    def digest(self) -> str:
        """SHA-256 of the specification of all cases."""
        return hashlib.sha256(self.whole.text().encode()).hexdigest()

    @cached_property
    def planned(self) -> Campaign:
        """Campaign of the development cases that run, with the controllers that run beside."""
        return self.development(self.beside, Path())

    def development(self, controllers: list[str], folder: Path) -> Campaign:
        """Return the campaign of the development cases; files are relative to `folder`."""
        return self._campaign(controllers, folder, self.content[ROOT_SEED])

    def held_out(self, controller: str, folder: Path, seed: int) -> Campaign:
        """Return the campaign of held-out cases, the judged controller first."""
        beside = [each for each in self.beside if each != controller]
        return self._campaign([controller, *beside], folder, seed)

    def _campaign(self, controllers: list[str], folder: Path, seed: int) -> Campaign:
        content = {**self.content, CONTROLLERS: controllers, ROOT_SEED: seed}
        if self.quick:
            random, floors = self.content[RANDOM], self.whole.floor_samples
            samples = random[SAMPLES]
            content[RANDOM] = {OF: samples, **random, SAMPLES: -(-samples // QUICK)}
            content[FLOOR_SAMPLES] = -(-floors // QUICK)
        return Campaign(spec_of(content, folder))
