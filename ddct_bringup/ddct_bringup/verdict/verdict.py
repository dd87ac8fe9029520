"""The verdict over one run: state, and each criterion beside its limit. Never one number."""

from collections.abc import Mapping
from typing import Any

from ddct_bringup.verdict.criteria import CRITERIA
from ddct_bringup.verdict.limits import Limit, Limits
from ddct_bringup.verdict.state import ENGAGED, INVALID

Verdict = dict[str, Any]
"""State, limits and criteria, as in `scores.json`."""
WITHIN, BEYOND, NO_LIMIT = 'within', 'beyond', 'no_limit'


def verdict_of(
    state: str, values: Mapping[str, float | int | None], limits: Limits, scenario: str
) -> Verdict:
    """
    Return the verdict over a run of a scenario, of its state and the values of its criteria.

    The run is beyond limits if one criterion is. It is within if it is engaged and every criterion
    with a limit is within: what never engaged has no engagement to keep within limits, and of a
    limit without a value, as in a run that ended early, nobody knows whether it was kept.
    """
    strictest = limits.of(scenario)
    criteria = [
        _judged(criterion.key, criterion.unit, values[criterion.key], strictest.get(criterion.key))
        for criterion in CRITERIA
    ]
    found = {criterion['state'] for criterion in criteria if criterion['limit'] is not None}
    overall = NO_LIMIT
    if BEYOND in found:
        overall = BEYOND
    elif state == ENGAGED and found == {WITHIN}:
        overall = WITHIN
    return {'state': state, 'limits': overall, 'criteria': criteria}


def verdict_of_unreadable() -> Verdict:
    """Return the verdict over a run of which nothing is known."""
    return {'state': INVALID, 'limits': NO_LIMIT, 'criteria': []}


def _judged(
    name: str, unit: str, value: float | int | None, limit: Limit | None
) -> dict[str, Any]:
    """Return one criterion; the magnitude of its value is what is limited."""
    state = NO_LIMIT
    if limit is not None and value is not None:
        state = WITHIN if abs(value) <= limit.value else BEYOND
    return {
        'name': name,
        'value': value,
        'unit': unit,
        'limit': limit.value if limit else None,
        'source': limit.source if limit else None,
        'state': state,
    }
