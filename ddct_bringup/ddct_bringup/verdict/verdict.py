# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Verdict of one run: its state, and each criterion with its limit. There is no overall score."""

from collections.abc import Mapping
from typing import Any

from ddct_bringup.verdict.criteria import CRITERIA
from ddct_bringup.verdict.limits import CONVENTION, Limit, Limits
from ddct_bringup.verdict.plant import JudgedPlant
from ddct_bringup.verdict.state import INVALID, SUCCESSES

Verdict = dict[str, Any]
"""State, limits, criteria and traction of a run, under the keys of `scores.json`."""
WITHIN, BEYOND, NO_LIMIT, FAILED = 'within', 'beyond', 'no_limit', 'failed'
TRACTION = 'traction'
"""Key of the traction in a verdict, next to the criteria."""
_TRACTION_UNIT = 'm/s^2'


def verdict_of(
    state: str,
    values: Mapping[str, float | int | None],
    limits: Limits,
    scenario: str,
    *,
    exists: Mapping[str, Any],
    traction: Mapping[str, Any] | None = None,
) -> Verdict:
    """
    Return the verdict of a run of a scenario from its state and the values of its criteria.

    A run that is neither engaged nor nearly engaged has failed, whatever its criteria are.
    Otherwise it is beyond limits if one criterion exceeds its limit, or if the wheels would spin.
    It is within limits if every criterion with a limit is; a criterion without a value, as in a
    run that ended early, cannot be compared with its limit. No limit applies to a criterion that
    is not defined for the plant: `exists` has this by criterion. `traction` is the result of
    `judged_traction`.
    """
    strictest = {key: limit for key, limit in limits.of(scenario).items() if exists[key]}
    criteria = [
        _judged(criterion.key, criterion.unit, values[criterion.key], strictest.get(criterion.key))
        for criterion in CRITERIA
    ]
    traction = traction or judged_traction(None, None, limits)
    found = {criterion['state'] for criterion in criteria if criterion['limit'] is not None}
    overall = NO_LIMIT
    if state not in SUCCESSES:
        overall = FAILED
    elif BEYOND in (*found, traction['state']):
        overall = BEYOND
    elif found == {WITHIN}:
        overall = WITHIN
    return {'state': state, 'limits': overall, 'criteria': criteria, TRACTION: dict(traction)}


def verdict_of_unreadable() -> Verdict:
    """Return the verdict of a run whose recording cannot be read."""
    return {'state': INVALID, 'limits': FAILED, 'criteria': [], TRACTION: None}


def judged_traction(
    value: float | int | None, plant: JudgedPlant | None, limits: Limits
) -> dict[str, Any]:
    """Return the largest driving force over the mass, and its limit for the driven axle."""
    rule = limits.traction
    limit = rule.limit(plant.gravity) if rule and plant else None
    return {
        'value': value,
        'unit': _TRACTION_UNIT,
        'limit': limit,
        'source': f'{CONVENTION}: {rule.reason}' if rule and plant else None,
        'convention': limit is not None,
        'state': _state(value, limit),
    }


def _judged(
    name: str, unit: str, value: float | int | None, limit: Limit | None
) -> dict[str, Any]:
    """Return the entry of one criterion; the limit applies to the magnitude of its value."""
    return {
        'name': name,
        'value': value,
        'unit': unit,
        'limit': limit.value if limit else None,
        'source': limit.source if limit else None,
        'convention': limit.convention if limit else False,
        'state': _state(value, limit.value if limit else None),
    }


def _state(value: float | int | None, limit: float | None) -> str:
    if value is None or limit is None:
        return NO_LIMIT
    return WITHIN if abs(value) <= limit else BEYOND
