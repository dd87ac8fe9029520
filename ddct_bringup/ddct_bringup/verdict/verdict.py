# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Verdict of one run: its state, and each criterion with its limit. There is no overall score."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from ddct_bringup.metrics.catalogue import CRITERIA
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.verdict.limits import TRACTION, TRACTION_UNIT, Limit, Limits
from ddct_bringup.verdict.state import INVALID, SUCCESSES

WITHIN, BEYOND, NO_LIMIT, FAILED = 'within', 'beyond', 'no_limit', 'failed'
UNAVOIDABLE = 'unavoidable'
"""State of a criterion whose limit no controller can keep in the scenario, and of such a run."""


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
    """WITHIN, BEYOND, UNAVOIDABLE or NO_LIMIT."""
    least: float | None = None
    """
    Least value in `unit` that a run with the same lock instant can have.

    None where it was not computed, or the run does not lock once and stay locked.
    """
    over_floor: float | None = None
    """Value over `least`; None without one, and where it is zero."""
    least_at_any_lock: float | None = None
    """Least value in `unit` whenever the plates lock; only where it exceeds the limit."""


@dataclass(frozen=True)
class Verdict:
    """Verdict of one run."""

    state: str
    """State at the end of the run, one of `STATES`."""
    limits: str
    """Comparison of all criteria with limits: WITHIN, BEYOND, UNAVOIDABLE, NO_LIMIT or FAILED."""
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


@dataclass(frozen=True)
class CriterionFloor:
    """Least values of one criterion, in its unit, beside the value of a run."""

    least: float | None
    """Least at the lock instant of the run; None where it was not computed."""
    over_floor: float | None
    """Value of the run over `least`; None where it is not defined."""
    at_any_lock: float | None
    """Least whenever the plates lock; None unless it was computed and exceeds the limit."""


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
    Otherwise it is beyond limits if one criterion exceeds its limit, or if the wheels would spin;
    with floors, unavoidable if that is only because no controller could keep within.
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
    return Verdict(state, _overall(state, criteria, traction), criteria, traction)


def verdict_with_floors(verdict: Verdict, floors: Mapping[str, CriterionFloor]) -> Verdict:
    """Return a verdict whose criteria, and traction, have these floors beside them, by name."""
    criteria = tuple(_with_floor(each, floors.get(each.name)) for each in verdict.criteria)
    traction = verdict.traction
    if traction is None:
        return verdict
    traction = _with_floor(traction, floors.get(TRACTION))
    return replace(
        verdict,
        limits=_overall(verdict.state, criteria, traction),
        criteria=criteria,
        traction=traction,
    )


def _overall(state: str, criteria: Sequence[CriterionResult], traction: CriterionResult) -> str:
    """Return the comparison of all criteria with their limits."""
    found = {criterion.state for criterion in criteria if criterion.limit is not None}
    if state not in SUCCESSES:
        return FAILED
    if BEYOND in (*found, traction.state):
        return BEYOND
    if UNAVOIDABLE in (*found, traction.state):
        return UNAVOIDABLE
    return WITHIN if found == {WITHIN} else NO_LIMIT


def _with_floor(result: CriterionResult, floor: CriterionFloor | None) -> CriterionResult:
    if floor is None:
        return result
    return replace(
        result,
        state=_state(result.value, result.limit, floor.at_any_lock),
        least=floor.least,
        over_floor=floor.over_floor,
        least_at_any_lock=floor.at_any_lock,
    )


def judged_traction(
    value: float | int | None, plant: JudgedPlant | None, limits: Limits
) -> CriterionResult:
    """Return the largest driving force over the mass, and its limit for the driven axle."""
    limit = None if plant is None else limits.of_traction(plant.gravity)
    return criterion_result(TRACTION, TRACTION_UNIT, value, limit)


def criterion_result(
    name: str, unit: str, value: float | int | None, limit: Limit | None
) -> CriterionResult:
    """
    Return the result of one criterion; the limit applies to the magnitude of its value.

    The result has no floor yet: `verdict_with_floors` sets it beside.
    """
    if limit is None:
        return CriterionResult(name, value, unit, None, None, False, NO_LIMIT)
    state = _state(value, limit.value)
    return CriterionResult(name, value, unit, limit.value, limit.source, limit.convention, state)


def _state(
    value: float | int | None, limit: float | None, at_any_lock: float | None = None
) -> str:
    """
    Return the state of a criterion, or of the traction, from its value and its limit.

    A value beyond a limit that is below the least at any lock instant is UNAVOIDABLE.
    """
    if value is None or limit is None:
        return NO_LIMIT
    if abs(value) <= limit:
        return WITHIN
    return BEYOND if at_any_lock is None or at_any_lock <= limit else UNAVOIDABLE
