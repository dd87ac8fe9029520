# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""SPEC.yaml: keys that a campaign varies; every mistake is reported with its line."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

from ddct_bringup.campaign.keys import COMMON, CONTROLLERS
from ddct_bringup.campaign.specification.distributions import Distribution
from ddct_bringup.campaign.specification.parts import (
    GRID,
    KNOWN,
    RANDOM,
    ROOT_SEED,
    common_of,
    controllers_of,
    grid_of,
    known_of,
    mapping_of,
    require_apart,
    samples_of,
)
from ddct_controllers.from_file.controller_file import is_controller_file
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import Option
from ddct_plant.files.input_file import SCHEMA_KEY, located, require_schema_version, user_text
from ddct_plant.files.yaml_text import parse_yaml_with_lines
from ddct_plant.scenario.choices.scenarios import CHOICES, Choice, is_packaged
from ddct_plant.scenario.file import ScenarioFile
from ddct_plant.scenario.key_names import scenario_options

SCHEMA_VERSION = 1
"""Schema version of a specification."""
_KEYS = (SCHEMA_KEY, CONTROLLERS, *COMMON, ROOT_SEED, GRID, RANDOM, KNOWN)
_ROOT = Option(0, 'root of all random numbers', at_least=0, at_most=2**31 - 1)


@dataclass(frozen=True)
class CampaignSpec:
    """A valid specification of a campaign."""

    content: Mapping[str, Any]
    """Specification as given."""
    folder: Path
    """Folder that files are relative to."""
    controllers: tuple[str, ...]
    common: Mapping[str, str]
    """Values for all runs: scenario, car, drive and architecture where they are given."""
    root: int
    grid: Mapping[str, tuple[Any, ...]]
    """Values on the grid by key."""
    samples: int
    vary: Mapping[str, Distribution]
    """Distributions of the keys that are drawn in each sample, by key."""
    known: tuple[str, ...] = ()
    """Varied keys that controllers learn, besides those that they know in any run."""
    of: int = 1
    """Number of samples of the whole campaign; the first `samples` of them run."""

    @property
    def keys(self) -> tuple[str, ...]:
        """Varied keys, in the order of the columns."""
        return (*self.grid, *self.vary)

    def values_of(self, key: str) -> tuple[Any, ...]:
        """Return the possible values of a key; none for a distribution of numbers."""
        return self.grid[key] if key in self.grid else self.vary[key].values

    @property
    def chosen(self) -> list[str]:
        """Names of the controllers, or the paths of their files."""
        return [
            str(self.folder / each) if is_controller_file(each) else each
            for each in self.controllers
        ]

    @property
    def choices(self) -> tuple[Choice, ...]:
        """Scenarios, cars and drives of the runs, with files as the specification names them."""
        values = (
            self.values_of(key) if key in self.keys else (self.common.get(key),) for key in CHOICES
        )
        return tuple(Choice(*each) for each in product(*values))

    def scenario_file(self, choice: Choice) -> ScenarioFile:
        """Return what a specification chooses; raise DdctError where that is invalid."""
        names = {
            key: name if is_packaged(name) else str(self.folder / name)
            for key, name in choice.given.items()
        }
        return ScenarioFile.read(Choice(**names))

    def text(self) -> str:
        """Return the specification as canonical text, independent of its formatting."""
        return json.dumps(self.content)


def _require_no_scenario_key(content: Any) -> None:
    """Raise ParameterError for a key of a scenario among those of a specification."""
    for key in content if isinstance(content, Mapping) else ():
        if key in scenario_options() and key not in _KEYS:
            raise ParameterError(
                f'{key} is a key of the scenario: give a scenario with it, or list its values in '
                f'{GRID}',
                key=key,
            )


def read_spec(file: str | Path) -> CampaignSpec:
    """Read a specification; raise DdctError that names file, line and key."""
    path = Path(file)
    with located(str(path)):
        content, lines = parse_yaml_with_lines(user_text(path))
    with located(str(path), lines):
        return spec_of(content, path.absolute().parent)


def spec_of(content: Any, folder: Path) -> CampaignSpec:
    """
    Return the specification in nested mappings; files in it are relative to `folder`.

    Raise ParameterError that names the key.
    """
    _require_no_scenario_key(content)
    content = mapping_of('the specification', content, _KEYS)
    require_schema_version(content, SCHEMA_VERSION)
    grid = grid_of(content)
    samples, of, vary = samples_of(content)
    if not grid and not vary:
        raise ParameterError(f'nothing is varied: give {GRID}, {RANDOM} or both')
    require_apart(content, (*grid, *vary))
    spec = CampaignSpec(
        content=content,
        folder=folder,
        controllers=controllers_of(content),
        common=common_of(content),
        root=int(_ROOT.checked(ROOT_SEED, content.get(ROOT_SEED, _ROOT.default))),
        grid=grid,
        samples=samples,
        vary=vary,
        known=known_of(content, (*grid, *vary)),
        of=of,
    )
    try:
        spec.text()
    except (TypeError, ValueError) as error:  # Python objects that no file can contain
        raise ParameterError(f'the specification holds what YAML does not: {error}') from error
    return spec
