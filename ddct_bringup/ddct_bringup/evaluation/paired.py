# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Differences of two controllers on the same cases."""

import math
from dataclasses import dataclass
from functools import cache

import numpy as np

from ddct_bringup.evaluation.share import CONFIDENCE
from ddct_bringup.evaluation.spread import Quantiles, quantiles_of
from ddct_bringup.verdict.state import ENGAGED
from ddct_plant.files.json_records import Inline

METHOD = 'sign test'


@dataclass(frozen=True)
class JointOutcomes:
    """Number of cases in which both, one or none of two controllers engaged."""

    cases: int
    both: int
    first_only: int
    second_only: int
    neither: int


def joint_outcomes(first: np.ndarray, second: np.ndarray) -> JointOutcomes:
    """Return the counts of joint outcomes of two controllers from (n,) outcomes, case by case."""
    ours, theirs = first == ENGAGED, second == ENGAGED
    counts = (ours & theirs, ours & ~theirs, ~ours & theirs, ~ours & ~theirs)
    return JointOutcomes(len(first), *(int(np.sum(each)) for each in counts))


@dataclass(frozen=True)
class PairedDifference:
    """Difference of two controllers in one quantity, first minus second."""

    cases: int
    """Number of cases in which both engaged and have a value."""
    quantiles: Inline[Quantiles]
    """Quantiles P5, P50, P95 of the difference of magnitudes."""
    interval: tuple[float, float] | None
    """Interval of the median for a random sample of cases; None for fewer than six."""


def difference_of(
    first: np.ndarray,
    second: np.ndarray,
    outcomes: tuple[np.ndarray, np.ndarray],
    *,
    sample: bool = True,
) -> PairedDifference:
    """
    Return the difference of magnitudes over the cases in which both engaged and have a value.

    `first` and `second` are the (n,) values of both controllers, NaN where there is none. Negative
    values are in favour of the first controller: smaller is better for each quantity. Cases that
    are no random `sample` have no interval.
    """
    both = (outcomes[0] == ENGAGED) & (outcomes[1] == ENGAGED)
    differences = (np.abs(first) - np.abs(second))[both]
    differences = differences[~np.isnan(differences)]
    interval = median_interval(differences) if sample else None
    return PairedDifference(len(differences), quantiles_of(differences), interval)


def median_interval(values: np.ndarray) -> tuple[float, float] | None:
    """
    Return the interval of the median by the sign test, valid for every distribution.

    Its ends are the values of rank k and n + 1 - k, with the largest k for which P(Binomial(n,
    1/2) < k) is at most 2.5 %. Fewer than six values have none.
    """
    runs = len(values)
    rank = _rank(runs)
    if rank < 1:
        return None
    ordered = np.sort(values)
    return float(ordered[rank - 1]), float(ordered[runs - rank])


@cache
def _rank(runs: int) -> int:
    """Return the rank of the lower end of the interval of a median; 0 for none."""
    # As scipy.stats.binom.ppf, whose import takes half a second.
    from scipy.special import bdtr, bdtrik

    if not runs:
        return 0
    outside = (1.0 - CONFIDENCE) / 2.0
    rank = math.ceil(bdtrik(outside, runs, 0.5))
    return rank - 1 if rank and bdtr(rank - 1, runs, 0.5) >= outside else rank
