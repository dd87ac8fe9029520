# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Thresholds of the states and limits of metrics, read from a limits file.

Every error in a limits file is reported with file, line and key.
"""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.metrics.metric import Metrics
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.verdict.limits_keys import (
    MOST,
    require_keys,
    require_text,
    require_unit,
    rule_value,
)
from ddct_bringup.verdict.of_car import LIMITS_OF_CAR, OF_CAR
from ddct_bringup.verdict.rules import Rules, rules_of
from ddct_bringup.verdict.traction import TractionRule
from ddct_plant.base.errors import ParameterError, require_number
from ddct_plant.files.input_file import SCHEMA_KEY, located, require_schema_version, user_text
from ddct_plant.files.yaml_text import parse_yaml_with_lines

SCHEMA_VERSION = 3
"""Schema version of a limits file."""
CONVENTION = 'convention'
TRACTION = 'driving_acceleration_m_s2'
"""Metric that the traction of the driven axle limits."""
_CITATION = ('source', 'clause')
_ORDER = {key: place for place, key in enumerate(METRICS)}


@dataclass(frozen=True)
class Limit:
    """Highest magnitude of one metric, in its unit."""

    metric: str
    """Key of the metric."""
    value: float | None
    """Value in `unit`; None where it follows from the car."""
    unit: str
    applies_to: tuple[str, ...] | None
    """Names of the scenarios that the limit applies to; None for all."""
    source: str
    """Publication and clause of the limit, or for a convention its reason."""
    convention: bool
    """Whether the limit is a convention rather than published."""


@dataclass(frozen=True)
class LimitResult:
    """Value of a metric of a run beside its limit; fields as in `scores.json`."""

    name: str
    """Key of the metric."""
    value: float | int | None
    """Value in `unit`; None where it is not defined."""
    limit: float
    """Largest magnitude in `unit`."""
    unit: str
    source: str
    """Publication and clause of the limit, or for a convention its reason."""
    convention: bool
    """Whether the limit is a convention rather than published."""


@dataclass(frozen=True)
class Limits:
    """Content of a limits file."""

    rules: Rules
    limits: tuple[Limit, ...]
    traction: TractionRule | None
    """Limit of the traction of the driven axle; None where the file has none."""
    origin: Mapping[str, str | int] = field(compare=False)
    """Name, digest and schema version of the file, under the keys of `scores.json`."""
    text: str = field(default='', compare=False, repr=False)
    """Text of the file; empty for the packaged one."""

    def beside(
        self, metrics: Metrics, scenario: str, plant: JudgedPlant | None
    ) -> tuple[LimitResult, ...]:
        """Return the metrics of a run beside their limits; without a plant no traction."""
        strictest = self.of(scenario, plant)
        return tuple(
            LimitResult(name, metrics[name], value, each.unit, each.source, each.convention)
            for name, (value, each) in sorted(strictest.items(), key=lambda of: _ORDER[of[0]])
        )

    def of(self, scenario: str, plant: JudgedPlant | None) -> dict[str, tuple[float, Limit]]:
        """
        Return value and strictest limit of each metric for a scenario, by the metric's key.

        Without a plant there are none that follow from the car.
        """
        strictest: dict[str, tuple[float, Limit]] = {}
        for limit in (*self.limits, *self._of_traction(plant)):
            value = limit.value
            if value is None and plant is not None:
                value = LIMITS_OF_CAR[limit.metric](plant)
            if value is None or (limit.applies_to and scenario not in limit.applies_to):
                continue
            if limit.metric not in strictest or value < strictest[limit.metric][0]:
                strictest[limit.metric] = value, limit
        return strictest

    def _of_traction(self, plant: JudgedPlant | None) -> tuple[Limit, ...]:
        """Return the limit of the traction; none without a plant, or where the file has none."""
        if self.traction is None or plant is None:
            return ()
        largest, reason = self.traction.limit(plant), f'{CONVENTION}: {self.traction.reason}'
        unit = METRICS[TRACTION].unit
        return (Limit(TRACTION, largest, unit, None, reason, convention=True),)


@cache
def packaged_limits() -> Limits:
    """Return the limits of the package, named `packaged`."""
    file = files('ddct_bringup.verdict') / 'limits.yaml'
    return limits_of_text(file.read_text(encoding='utf-8'), 'packaged')


def load_limits(file: str | Path | None) -> Limits:
    """Return the limits of a file, the packaged ones for None; raise DdctError with its name."""
    if file is None:
        return packaged_limits()
    path = Path(file)
    with located(f'limits {path}'):
        text = user_text(path)
    return replace(limits_of_text(text, str(path)), text=text)


def limits_of_text(text: str, name: str) -> Limits:
    """
    Return the limits of a text under the name `name`.

    Their origin has the name without its folders, and a digest that distinguishes files of the
    same name. Raise ParameterError with the key of the first error.
    """
    with located(f'limits {name}'):
        content, lines = parse_yaml_with_lines(text)
    digest = hashlib.sha256(text.encode()).hexdigest()[:16]
    with located(f'limits {name}', lines):
        top = require_keys('', content, ('rules', 'limits'), (SCHEMA_KEY, 'traction'))
        require_schema_version(top, SCHEMA_VERSION)
        origin: Mapping[str, str | int] = {
            'name': Path(name).name,
            'digest': digest,
            'schema_version': SCHEMA_VERSION,
        }
        if not isinstance(top['limits'], list):
            raise ParameterError('limits: give a list of limits')
        limits = [_limit(f'limits[{i}]', item) for i, item in enumerate(top['limits'])]
        traction = _traction(top['traction']) if 'traction' in top else None
        return Limits(rules_of('rules', top['rules']), tuple(limits), traction, origin)


def _traction(content: Any) -> TractionRule:
    of_car = ('driven_share', 'height_over_wheelbase')
    rules = require_keys('traction', content, ('friction', *of_car, 'reason'))
    require_text('traction.reason', rules['reason'])
    values = {
        name: None if rules[name] == OF_CAR else rule_value(f'traction.{name}', rules[name], '1')
        for name in of_car
    }
    friction = rule_value('traction.friction', rules['friction'], '1')
    return TractionRule(friction, **values, reason=rules['reason'])


def _limit(path: str, content: Any) -> Limit:
    required = ('metric', 'value', 'unit', 'applies_to')
    limit = require_keys(path, content, required, (*_CITATION, CONVENTION, 'reason'))
    metric = limit['metric']
    if not isinstance(metric, str) or metric not in METRICS:
        known = ', '.join(METRICS)
        raise ParameterError(f'{path}.metric: {metric!r} is unknown: choose from {known}')
    require_unit(f'{path}.unit', limit['unit'], METRICS[metric].unit)
    return Limit(
        metric,
        _value(path, limit),
        limit['unit'],
        _scenarios(f'{path}.applies_to', limit['applies_to']),
        _source(path, limit),
        limit.get(CONVENTION, False),
    )


def _value(path: str, limit: Mapping[str, Any]) -> float | None:
    """Return the value of a limit; None where it follows from the car."""
    if limit['value'] != OF_CAR:
        return require_number(f'{path}.value: it', limit['value'], at_least=0.0, at_most=MOST)
    if limit['metric'] not in LIMITS_OF_CAR:
        raise ParameterError(
            f'{path}.value: no limit of {limit["metric"]} follows from the car, only of '
            f'{", ".join(LIMITS_OF_CAR)}: give a number',
            key=f'{path}.value',
        )
    return None


def _source(path: str, limit: Mapping[str, Any]) -> str:
    if not isinstance(limit.get(CONVENTION, False), bool):
        raise ParameterError(
            f'{path}.{CONVENTION}: give true or false', key=f'{path}.{CONVENTION}'
        )
    if limit.get(CONVENTION):
        return _convention(path, limit)
    if 'reason' in limit:
        raise ParameterError(
            f'{path}.reason: only a convention has one: cite a clause, or add it',
            key=f'{path}.reason',
        )
    for key in _CITATION:
        if key not in limit:
            raise ParameterError(
                f'{path}: {key} is missing: cite it, or add `convention: true`', key=key
            )
        require_text(f'{path}.{key}', limit[key])
    return f'{limit["source"]}, {limit["clause"]}'


def _convention(path: str, limit: Mapping[str, Any]) -> str:
    if 'reason' not in limit:
        raise ParameterError(
            f'{path}: reason is missing: say why this value is agreed on', key=f'{path}.reason'
        )
    require_text(f'{path}.reason', limit['reason'])
    return f'{CONVENTION}: {limit["reason"]}'


def _scenarios(path: str, value: Any) -> tuple[str, ...] | None:
    if value == 'all':
        return None
    names = isinstance(value, list) and value
    if not names or not all(isinstance(name, str) for name in value):
        raise ParameterError(f"{path}: give 'all' or a list of scenarios")
    return tuple(value)
