# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Parts of a specification: controllers, grid, random samples; mistakes name the key."""

from collections.abc import Mapping, Sequence
from typing import Any

from ddct_bringup.campaign.keys import COMMON, CONTROLLERS, option_of, run_options
from ddct_bringup.campaign.specification.distribution import distribution_of
from ddct_bringup.campaign.specification.distributions import Distribution
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.options import Option, require_known
from ddct_plant.files.input_file import located
from ddct_plant.scenario.case import OF_CASE
from ddct_plant.scenario.choices.scenarios import CHOICES

MOST_RUNS = 10_000_000
"""Largest number of runs of one campaign."""
GRID, VARY, KNOWN = 'grid', 'vary', 'known'
RANDOM, SAMPLES, OF, ROOT_SEED = 'random', 'samples', 'of', 'seed'


def mapping_of(
    what: str, content: Any, known: tuple[str, ...], prefix: str = ''
) -> dict[str, Any]:
    """Return a group of keys; raise ParameterError for another value or an unknown key."""
    if not isinstance(content, Mapping):
        raise ParameterError(f'{what} is {content!r}: give keys and values', key=what)
    require_known(content, known, prefix=prefix)
    return dict(content)


def controllers_of(content: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the names or files of the controllers."""
    given = content.get(CONTROLLERS)
    if not isinstance(given, list) or not given:
        raise ParameterError(
            f'{CONTROLLERS}: give a list of names or files, such as [pi, mpc3]', key=CONTROLLERS
        )
    return _distinct(CONTROLLERS, [_text(CONTROLLERS, each) for each in given])


def common_of(content: Mapping[str, Any]) -> dict[str, str]:
    """Return the values for all runs by key."""
    given = {key: _text(key, content[key]) for key in COMMON if key in content}
    for key, value in given.items():
        if key not in CHOICES:
            run_options()[key].checked(key, value)
    return given


def _text(key: str, value: Any) -> str:
    if not isinstance(value, str) or not value:
        raise ParameterError(f'{key} is {value!r}: give text', key=key)
    return value


def grid_of(content: Mapping[str, Any]) -> dict[str, tuple[Any, ...]]:
    """Return the values on the grid by key."""
    if GRID not in content:
        return {}
    given = _not_empty(GRID, content[GRID])
    grid = {}
    for key, values in given.items():
        where = f'{GRID}.{key}'
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


def known_of(content: Mapping[str, Any], varied: Sequence[str]) -> tuple[str, ...]:
    """Return the varied keys that controllers learn."""
    given = content.get(KNOWN, [])
    if not isinstance(given, list):
        raise ParameterError(
            f'{KNOWN} is {given!r}: give a list of keys that vary, such as [vehicle.mass_kg]',
            key=KNOWN,
        )
    for key in given:
        if key in OF_CASE:
            raise ParameterError(
                f'{KNOWN}: {key} is of the case alone, and no controller can learn it: leave it '
                'out',
                key=KNOWN,
            )
    with located(KNOWN):
        require_known(given, varied, 'key that varies')
    return _distinct(KNOWN, given)


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


def samples_of(content: Mapping[str, Any]) -> tuple[int, int, dict[str, Distribution]]:
    """Return the numbers of samples that run and of all samples, and the distributions."""
    if RANDOM not in content:
        return 1, 1, {}
    given = mapping_of(RANDOM, content[RANDOM], (SAMPLES, OF, VARY), f'{RANDOM}.')
    where = f'{RANDOM}.{SAMPLES}'
    if SAMPLES not in given:
        raise ParameterError(f'{where} is missing: say how many samples to draw', key=where)
    samples = _count(where, given[SAMPLES])
    of = _count(f'{RANDOM}.{OF}', given.get(OF, samples), at_least=samples)
    vary = {}
    for key, described in _not_empty(f'{RANDOM}.{VARY}', given.get(VARY)).items():
        where = f'{RANDOM}.{VARY}.{key}'
        vary[key] = distribution_of(where, described, option_of(where, key))
    return samples, of, vary


def _count(where: str, value: Any, at_least: int = 1) -> int:
    """Return a number of samples in its range; raise ParameterError that names the key."""
    option = Option(1, 'number of samples', at_least=at_least, at_most=MOST_RUNS)
    return int(option.checked(where, value))


def require_apart(content: Mapping[str, Any], keys: tuple[str, ...]) -> None:
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
