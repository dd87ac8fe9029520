# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""SPEC.yaml: keys that a campaign varies; every mistake is reported with its line."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ddct_bringup.campaign.distributions import Distribution, distribution_of
from ddct_bringup.campaign.keys import COMMON, CONTROLLERS, SCENARIO, option_of, run_options
from ddct_bringup.floor.floor import METRICS
from ddct_plant.base.errors import ParameterError, require_choice
from ddct_plant.base.options import Option, require_known
from ddct_plant.files.input_file import SCHEMA_KEY, located, require_schema_version, user_text
from ddct_plant.files.yaml_text import parse_yaml_with_lines
from ddct_plant.scenario.file import ScenarioFile, is_packaged

SCHEMA_VERSION = 1
"""Schema version of a specification."""
MOST_RUNS = 10_000_000
"""Largest number of runs of one campaign."""
_GRID, _RANDOM, _VARY, _SAMPLES, _SEED = 'grid', 'random', 'vary', 'samples', 'seed'
FLOORS = 'floors'
_KEYS = (SCHEMA_KEY, CONTROLLERS, *COMMON, _SEED, _GRID, _RANDOM, FLOORS)
_ROOT = Option(0, 'root of all random numbers', at_least=0, at_most=2**31 - 1)
_NUMBER_OF_SAMPLES = Option(1, 'samples at each point of the grid', at_least=1, at_most=MOST_RUNS)


@dataclass(frozen=True)
class CampaignSpec:
    """A valid specification of a campaign."""

    content: Mapping[str, Any]
    """Specification as given."""
    folder: Path
    """Folder that files are relative to."""
    controllers: tuple[str, ...]
    common: Mapping[str, str]
    """Values for all runs: `scenario`, and `architecture` and `clutch` where they are given."""
    root: int
    grid: Mapping[str, tuple[Any, ...]]
    """Values on the grid by key."""
    samples: int
    vary: Mapping[str, Distribution]
    """Distributions of the keys that are drawn in each sample, by key."""
    floors: tuple[str, ...] = ()
    """Metrics that are set beside the least that any controller could have."""

    @property
    def keys(self) -> tuple[str, ...]:
        """Varied keys, in the order of the columns."""
        return (*self.grid, *self.vary)

    def values_of(self, key: str) -> tuple[Any, ...]:
        """Return the possible values of a key; none for a distribution of numbers."""
        return self.grid[key] if key in self.grid else self.vary[key].values

    def scenario_file(self, name: str) -> ScenarioFile:
        """Return a scenario that a specification names; raise DdctError for an invalid one."""
        return ScenarioFile.read(name if is_packaged(name) else str(self.folder / name))

    def text(self) -> str:
        """Return the specification as canonical text, independent of its formatting."""
        return json.dumps(self.content)


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
    content = _mapping('the specification', content, _KEYS)
    require_schema_version(content, SCHEMA_VERSION)
    grid = _grid(content)
    samples, vary = _random(content)
    if not grid and not vary:
        raise ParameterError(f'nothing is varied: give {_GRID}, {_RANDOM} or both')
    _require_apart(content, (*grid, *vary))
    spec = CampaignSpec(
        content=content,
        folder=folder,
        controllers=_controllers(content),
        common=_common(content),
        root=int(_ROOT.checked(_SEED, content.get(_SEED, _ROOT.default))),
        grid=grid,
        samples=samples,
        vary=vary,
        floors=_floors(content),
    )
    try:
        spec.text()
    except (TypeError, ValueError) as error:  # Python objects that no file can contain
        raise ParameterError(f'the specification holds what YAML does not: {error}') from error
    return spec


def _mapping(what: str, content: Any, known: tuple[str, ...], prefix: str = '') -> dict[str, Any]:
    if not isinstance(content, Mapping):
        raise ParameterError(f'{what} is {content!r}: give keys and values', key=what)
    require_known(content, known, prefix=prefix)
    return dict(content)


def _controllers(content: Mapping[str, Any]) -> tuple[str, ...]:
    given = content.get(CONTROLLERS)
    if not isinstance(given, list) or not given:
        raise ParameterError(
            f'{CONTROLLERS}: give a list of names or files, such as [pi, mpc3]', key=CONTROLLERS
        )
    return _distinct(CONTROLLERS, [_text(CONTROLLERS, each) for each in given])


def _floors(content: Mapping[str, Any]) -> tuple[str, ...]:
    given = content.get(FLOORS, [])
    if not isinstance(given, list):
        raise ParameterError(f'{FLOORS}: give a list of metrics, such as [peak_jerk]', key=FLOORS)
    for name in given:
        require_choice(FLOORS, name, list(METRICS))
    return _distinct(FLOORS, given)


def _common(content: Mapping[str, Any]) -> dict[str, str]:
    given = {key: _text(key, content[key]) for key in COMMON if key in content}
    for key, value in given.items():
        if key != SCENARIO:
            run_options()[key].checked(key, value)
    return {SCENARIO: 'thesis', **given}


def _text(key: str, value: Any) -> str:
    if not isinstance(value, str) or not value:
        raise ParameterError(f'{key} is {value!r}: give text', key=key)
    return value


def _grid(content: Mapping[str, Any]) -> dict[str, tuple[Any, ...]]:
    if _GRID not in content:
        return {}
    given = _not_empty(_GRID, content[_GRID])
    grid = {}
    for key, values in given.items():
        where = f'{_GRID}.{key}'
        option = option_of(where, key)
        if not isinstance(values, list) or not values:
            raise ParameterError(
                f'{where} is {values!r}: give a list of values, not empty', key=where
            )
        for value in values:
            if option:
                option.checked(where, value)
        grid[key] = _distinct(where, values)
    return grid


def _not_empty(where: str, content: Any) -> Mapping[str, Any]:
    if not isinstance(content, Mapping) or not content:
        problem = f'is {content!r}' if content else 'is empty'
        raise ParameterError(
            f'{where} {problem}: give keys and what they are, or leave it out', key=where
        )
    for key in content:
        if not isinstance(key, str):
            raise ParameterError(
                f'{where} has the key {key!r}: give names, such as wear_gain', key=where
            )
    return content


def _random(content: Mapping[str, Any]) -> tuple[int, dict[str, Distribution]]:
    if _RANDOM not in content:
        return 1, {}
    given = _mapping(_RANDOM, content[_RANDOM], (_SAMPLES, _VARY), f'{_RANDOM}.')
    where = f'{_RANDOM}.{_SAMPLES}'
    if _SAMPLES not in given:
        raise ParameterError(f'{where} is missing: say how many samples to draw', key=where)
    samples = int(_NUMBER_OF_SAMPLES.checked(where, given[_SAMPLES]))
    vary = {}
    for key, described in _not_empty(f'{_RANDOM}.{_VARY}', given.get(_VARY)).items():
        where = f'{_RANDOM}.{_VARY}.{key}'
        vary[key] = distribution_of(where, described, option_of(where, key))
    return samples, vary


def _require_apart(content: Mapping[str, Any], keys: tuple[str, ...]) -> None:
    """Raise ParameterError for a key that is given twice, or inside another."""
    for place, key in enumerate(keys):
        if key in content:
            raise ParameterError(f'{key} is given for all runs and varied: give it once', key=key)
        for other in keys[:place]:
            if key == other or key.startswith(f'{other}.') or other.startswith(f'{key}.'):
                raise ParameterError(f'{key} varies beside {other}: give one of them', key=key)


def _distinct(where: str, values: list[Any]) -> tuple[Any, ...]:
    for place, value in enumerate(values):
        if value in values[:place]:
            raise ParameterError(f'{where} has {value!r} twice: give each once', key=where)
    return tuple(values)
