"""
What some runs came to: which engagements failed, where failure begins, and how bad it becomes.

    engaged   the run is valid, and the state of its verdict is `engaged`
    failed    the run is valid, and its state is any other
    invalid   the run does not count: it is neither, and is never left out

A criterion beyond its limit is no failed engagement: the verdict tells the two apart.

Quantities are magnitudes, of which less is better. A run that failed, is invalid or has no value
ranks behind every value, so that it can only make a figure worse: where it takes part in a median
or a mean, that has no value.
"""

from dataclasses import dataclass

import numpy as np
import scipy

from ddct_bringup.verdict.criteria import finite
from ddct_bringup.verdict.state import ENGAGED, INVALID

FAILED = 'failed'
CONFIDENCE = 0.95
METHOD = 'Clopper-Pearson'
ONE_IN = 20
"""The worst runs are one in so many: 5 %."""


@dataclass(frozen=True)
class FailedShare:
    """How many engagements of some runs failed."""

    runs: int
    engaged: int
    failed: int
    invalid: int

    @property
    def share(self) -> float | None:
        """Failed among the valid runs, 0 to 1; None without a valid one."""
        valid = self.runs - self.invalid
        return self.failed / valid if valid else None

    def interval(self) -> tuple[float, float]:
        """
        Return the ends of the Clopper-Pearson interval of the share, for runs that are a sample.

        Nobody knows what an invalid run would have come to: the lower end takes all of them for
        engaged, the upper end for failed.
        """
        outside = (1.0 - CONFIDENCE) / 2.0
        least, most, runs = self.failed, self.failed + self.invalid, self.runs
        lower = float(scipy.special.betaincinv(least, runs - least + 1, outside)) if least else 0.0
        upper = 1.0
        if most < runs:
            upper = float(scipy.special.betaincinv(most + 1, runs - most, 1.0 - outside))
        return lower, upper


def outcomes_of(valid: np.ndarray, states: np.ndarray) -> np.ndarray:
    """Return `engaged`, `failed` or `invalid` per run; both arguments are (n,)."""
    counts = valid.astype(bool) & (states != INVALID)
    return np.where(counts, np.where(states == ENGAGED, ENGAGED, FAILED), INVALID)


def failed_share(outcomes: np.ndarray) -> FailedShare:
    """Return the counts of (n,) outcomes."""
    engaged, failed, invalid = (
        int(np.sum(outcomes == outcome)) for outcome in (ENGAGED, FAILED, INVALID)
    )
    return FailedShare(len(outcomes), engaged, failed, invalid)


@dataclass(frozen=True)
class WayOut:
    """What happens on the way from the start to one end of the range."""

    held_to: float | None
    """The last value before the first failure, or the end of the range; None where none held."""
    first_failure: float | None
    """The first value at which not every run is engaged; None where there is none."""
    row: int | None
    """Position of a run there: the first failed one, the first invalid one without any."""
    lost: int = 0
    """How many runs there are not engaged."""
    runs: int = 0
    """How many runs there are at that value."""


def ways_out(values: np.ndarray, outcomes: np.ndarray, start: float) -> dict[str, WayOut]:
    """
    Return the ways `below` and `above`, over (n,) values of one quantity, going out from `start`.

    A value holds when all its runs are engaged. An invalid run holds nothing.
    """
    return {
        'below': _way(values, outcomes, start - values),
        'above': _way(values, outcomes, values - start),
    }


def _way(values: np.ndarray, outcomes: np.ndarray, distance: np.ndarray) -> WayOut:
    """Return the way along (n,) distances from the start; those below zero are not on it."""
    lost = np.where((distance >= 0.0) & (outcomes != ENGAGED), distance, np.inf)
    first = float(lost.min())
    held = np.where((distance >= 0.0) & (distance < first), distance, -np.inf)
    held_to = None if np.isinf(held).all() else float(values[held.argmax()])
    if np.isinf(first):
        return WayOut(held_to, None, None)
    rows = np.flatnonzero(lost == first)
    row = int(max(rows, key=lambda each: (outcomes[each] == FAILED, -each)))
    runs = int(np.sum(distance == first))
    return WayOut(held_to, float(values[row]), row, len(rows), runs)


@dataclass(frozen=True)
class Tail:
    """Figures of one quantity over some runs; runs by their position among them."""

    with_value: int
    """Engaged runs that have one."""
    median: float | None
    cvar: float | None
    """Conditional value at risk: the mean of the worst 5 %."""
    runs: int
    """How many are the worst 5 %, rounded up."""
    lacking: int
    """How many of those rank behind every value."""
    worst_engaged: int | None
    """The engaged run with the largest value, the first of equals."""
    worst: int | None
    """The same of the valid runs, failed ones too."""


def tail_of(values: np.ndarray, outcomes: np.ndarray) -> Tail:
    """Return the figures of (n,) values, NaN where there is none, with the runs' outcomes."""
    magnitudes = np.abs(values)
    ranked = np.where(outcomes == ENGAGED, magnitudes, np.nan)
    ordered = np.where(np.isnan(ranked), np.inf, ranked)
    infinite = int(np.sum(np.isinf(ordered)))
    runs = -(-len(ordered) // ONE_IN)
    return Tail(
        with_value=len(ordered) - infinite,
        median=finite(np.median(ordered)),
        cvar=finite(conditional_value_at_risk(ordered)),
        runs=runs,
        lacking=min(infinite, runs),
        worst_engaged=_largest(ranked),
        worst=_largest(np.where(outcomes == INVALID, np.nan, magnitudes)),
    )


def conditional_value_at_risk(values: np.ndarray) -> float:
    """
    Return the mean of the largest n / 20 of (n,) values, n >= 1.

    Where that is no whole number, the next value counts with the rest of it (Rockafellar and
    Uryasev 2002, Proposition 8). Of fewer than 20 values it is the largest.
    """
    descending = np.sort(values)[::-1]
    whole, rest = divmod(len(values), ONE_IN)
    total = float(np.sum(descending[:whole]))
    if rest:
        total += rest / ONE_IN * float(descending[whole])
    return total / (len(values) / ONE_IN)


def _largest(magnitudes: np.ndarray) -> int | None:
    """Return the first position of the largest of (n,) magnitudes that are not NaN."""
    return None if np.isnan(magnitudes).all() else int(np.nanargmax(magnitudes))
