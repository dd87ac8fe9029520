# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Verdict of one run: its state, and each criterion with its limit. There is no overall score."""

from collections.abc import Mapping
from dataclasses import dataclass

from ddct_bringup.metrics.catalogue import CRITERIA
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.verdict.limits import CONVENTION, Limit, Limits
from ddct_bringup.verdict.state import INVALID, SUCCESSES

WITHIN, BEYOND, NO_LIMIT, FAILED = 'within', 'beyond', 'no_limit', 'failed'
TRACTION = 'traction'
"""Name of the traction, which is judged next to the criteria."""
_TRACTION_UNIT = 'm/s^2'


@dataclass(frozen=True)
class CriterionResult:
    """Value of one criterion in a run, compared with its limit; fields as in `scores.json`."""

    name: str
    """Name of the criterion, or `TRACTION`."""
    value: float | int | None
    """Value in `unit`; None where it is not defined."""
    unit: str
    limit: float | None
    """Largest magnitude in `unit`; None where no limit applies."""
    source: str | None
    """Publication and clause of the limit, or for a convention its reason."""
    convention: bool
    """Whether the limit is a convention rather than published."""
    state: str
    """WITHIN, BEYOND or NO_LIMIT."""


@dataclass(frozen=True)
class Verdict:
    """Verdict of one run."""

    state: str
    """State at the end of the run, one of `STATES`."""
    limits: str
    """Comparison of all criteria with their limits: WITHIN, BEYOND, NO_LIMIT or FAILED."""
    criteria: tuple[CriterionResult, ...]
    """Result of every criterion, in the order of `CRITERIA`; empty of an unreadable run."""
    traction: CriterionResult | None
    """Largest driving force over the mass in m/s^2 as a criterion; None of an unreadable run."""

    @property
    def results(self) -> tuple[CriterionResult, ...]:
        """Results of all criteria, followed by the traction."""
        return self.criteria if self.traction is None else (*self.criteria, self.traction)

    @property
    def values(self) -> dict[str, float | int | None]:
        """Value of every criterion by name, without the traction."""
        return {each.name: each.value for each in self.criteria}


UNREADABLE = Verdict(INVALID, FAILED, (), None)
"""Verdict of a run whose recording cannot be read."""


def verdict_of(
    state: str,
    values: Mapping[str, float | int | None],
    limits: Limits,
    scenario: str,
    *,
    exists: Mapping[str, object],
    traction: CriterionResult | None = None,
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
    criteria = tuple(
        criterion_result(
            criterion.key, criterion.unit, values[criterion.key], strictest.get(criterion.key)
        )
        for criterion in CRITERIA
    )
    traction = traction or judged_traction(None, None, limits)
    found = {criterion.state for criterion in criteria if criterion.limit is not None}
    overall = NO_LIMIT
    if state not in SUCCESSES:
        overall = FAILED
    elif BEYOND in (*found, traction.state):
        overall = BEYOND
    elif found == {WITHIN}:
        overall = WITHIN
    return Verdict(state, overall, criteria, traction)


def judged_traction(
    value: float | int | None, plant: JudgedPlant | None, limits: Limits
) -> CriterionResult:
    """Return the largest driving force over the mass, and its limit for the driven axle."""
    rule = limits.traction
    if rule is None or plant is None:
        return criterion_result(TRACTION, _TRACTION_UNIT, value, None)
    largest, reason = rule.limit(plant.gravity), f'{CONVENTION}: {rule.reason}'
    limit = Limit(TRACTION, largest, _TRACTION_UNIT, None, reason, convention=True)
    return criterion_result(TRACTION, _TRACTION_UNIT, value, limit)


def criterion_result(
    name: str, unit: str, value: float | int | None, limit: Limit | None
) -> CriterionResult:
    """
    Return the result of one criterion; the limit applies to the magnitude of its value.

    The state of every criterion, and of the traction, is decided here.
    """
    if limit is None:
        return CriterionResult(name, value, unit, None, None, False, NO_LIMIT)
    state = NO_LIMIT
    if value is not None:
        state = WITHIN if abs(value) <= limit.value else BEYOND
    return CriterionResult(name, value, unit, limit.value, limit.source, limit.convention, state)
