"""What a run is judged by: the rules of the states, and the limits of the criteria."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any


def _rule(unit: str, at_least: float | None = None) -> float:
    return field(metadata={'unit': unit, 'at_least': at_least})


@dataclass(frozen=True)
class Rules:
    """Thresholds of the states, and what the criteria assume; their reasons stand in the file."""

    engaged_slip: float = _rule('rpm')
    """Magnitude of w_d below which the plates of a linear clutch count as one."""
    locked_slip: float = _rule('rpm')
    """The same of a clutch that sticks, where it has not locked."""
    settled_time: float = _rule('s')
    """How long the slip has to keep below it at the end of the run."""
    oscillation_turns: float = _rule('1', at_least=3.0)
    """Turns of the slip after control start from which it goes to and fro; 3 make a cycle."""
    runaway_slip: float = _rule('rpm')
    """Magnitude of w_d beyond which the plates have been driven apart."""
    runaway_growth: float = _rule('rpm/s')
    """Growth of the magnitude of w_d at the end from which they are being driven apart."""
    runaway_swing: float = _rule('1', at_least=1.0)
    """How far a swing reaches of what was reached before, from which they grow without end."""
    engagements_a_day: float = _rule('1')
    """For the daily vibration dose."""


@dataclass(frozen=True)
class Limit:
    """Highest magnitude of one criterion, in its unit."""

    criterion: str
    value: float
    unit: str
    applies_to: tuple[str, ...] | None
    """Names of scenarios; None for all."""
    source: str
    """Where it is published and in which clause, or that it is a convention."""

    def holds_for(self, scenario: str) -> bool:
        """Say whether it applies to runs of a scenario."""
        return self.applies_to is None or scenario in self.applies_to


@dataclass(frozen=True)
class Limits:
    """Content of a limits file."""

    rules: Rules
    limits: tuple[Limit, ...]
    origin: dict[str, Any] = field(compare=False, default_factory=dict)
    """`name`, `digest` and `schema_version` of the file, as `scores.json` has them."""

    def of(self, criterion: str, scenario: str) -> Limit | None:
        """Return the strictest limit of a criterion for a scenario, None without one."""
        asked = criterion, scenario
        if asked not in self._strictest:
            found = [
                limit
                for limit in self.limits
                if limit.criterion == criterion and limit.holds_for(scenario)
            ]
            self._strictest[asked] = min(found, key=_value, default=None)
        return self._strictest[asked]

    @cached_property
    def _strictest(self) -> dict[tuple[str, str], Limit | None]:
        """What `of` has found so far: many runs ask the same."""
        return {}


def _value(limit: Limit) -> float:
    return limit.value
