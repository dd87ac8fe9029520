"""
How bad a quantity becomes over some runs: its median, the mean of its worst 5 %, its worst case.

Quantities are magnitudes, of which less is better. A run that failed, is invalid or has no value
ranks behind every value, so that it can only make a figure worse: where it takes part in a median
or a mean, that has no value.
"""

from dataclasses import dataclass

import numpy as np

from ddct_bringup.verdict.state import ENGAGED, INVALID

ONE_IN = 20
"""The worst runs are one in so many: 5 %."""


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
        median=_finite(np.median(ordered)),
        cvar=_finite(conditional_value_at_risk(ordered)),
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


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _largest(magnitudes: np.ndarray) -> int | None:
    """Return the first position of the largest of (n,) magnitudes that are not NaN."""
    return None if np.isnan(magnitudes).all() else int(np.nanargmax(magnitudes))
