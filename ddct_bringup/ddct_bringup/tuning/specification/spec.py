# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""SPEC.yaml of a tuning: parameters, objectives, constraints, cases; mistakes name the line."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ddct_bringup.campaign.specification.parts import ROOT_SEED, mapping_of
from ddct_bringup.tuning.specification.development import CAMPAIGN, Development
from ddct_bringup.tuning.specification.goals import (
    CONSTRAINTS,
    OBJECTIVES,
    Constraint,
    Goal,
    constraints_of,
    objectives_of,
    require_engaged,
)
from ddct_bringup.tuning.specification.packaged_specs import PACKAGED, packaged_specs
from ddct_bringup.tuning.specification.parameters import PARAMETERS, Parameter, parameters_of
from ddct_controllers.interface import Controller, ControllerSpec
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import Option
from ddct_plant.files.input_file import SCHEMA_KEY, located, require_schema_version, user_text
from ddct_plant.files.yaml_text import parse_yaml_with_lines

SCHEMA_VERSION = 1
"""Schema version of a specification."""
TRIALS = 'trials'
_KEYS = (SCHEMA_KEY, PARAMETERS, OBJECTIVES, CONSTRAINTS, CAMPAIGN, TRIALS, ROOT_SEED)
_TRIALS = Option(100, 'number of trials', at_least=1, at_most=100_000)
_SEED = Option(0, 'seed of the search', at_least=0, at_most=2**31 - 1)


@dataclass(frozen=True)
class TuningSpec:
    """A valid specification of a tuning of one controller."""

    content: Mapping[str, Any]
    """Specification as given."""
    folder: Path
    """Folder that files are relative to."""
    parameters: tuple[Parameter, ...]
    objectives: tuple[Goal, ...]
    constraints: tuple[Constraint, ...]
    development: Development
    trials: int
    seed: int

    @property
    def goals(self) -> tuple[Goal, ...]:
        """Quantities of objectives, then those of constraints."""
        return (*self.objectives, *(each.goal for each in self.constraints))

    def text(self) -> str:
        """Return the specification as canonical text, independent of its formatting."""
        return json.dumps(self.content)


def read_tuning_spec(given: str, controller: ControllerSpec[Controller]) -> TuningSpec:
    """Read a file, or a packaged one by its name; raise DdctError with file, line and key."""
    path = Path(given)
    if given in packaged_specs():
        path = PACKAGED / f'{given}.yaml'
    with located(str(path)):
        content, lines = parse_yaml_with_lines(user_text(path))
    with located(str(path), lines):
        return tuning_spec_of(content, path.absolute().parent, controller)


def tuning_spec_of(
    content: Any, folder: Path, controller: ControllerSpec[Controller]
) -> TuningSpec:
    """
    Return the specification in nested mappings; files in it are relative to `folder`.

    Raise ParameterError that names the key.
    """
    given = mapping_of('the specification', content, _KEYS)
    require_schema_version(given, SCHEMA_VERSION)
    for key in (PARAMETERS, OBJECTIVES, CAMPAIGN):
        if key not in given:
            raise ParameterError(f'{key} is missing: docs/use/tune.md has an example', key=key)
    objectives = objectives_of(given[OBJECTIVES])
    constraints = constraints_of(given.get(CONSTRAINTS))
    require_engaged(objectives, constraints)
    return TuningSpec(
        content=given,
        folder=folder,
        parameters=parameters_of(given[PARAMETERS], controller),
        objectives=objectives,
        constraints=constraints,
        development=Development.of(given[CAMPAIGN], folder),
        trials=int(_TRIALS.checked(TRIALS, given.get(TRIALS, _TRIALS.default))),
        seed=int(_SEED.checked(ROOT_SEED, given.get(ROOT_SEED, _SEED.default))),
    )
