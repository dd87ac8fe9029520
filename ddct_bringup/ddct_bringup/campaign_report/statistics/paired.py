# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Differences of two controllers on the same cases."""

import math
from dataclasses import dataclass

import numpy as np
import scipy

from ddct_bringup.campaign_report.statistics.outcome import CONFIDENCE
from ddct_bringup.campaign_report.statistics.spread import Quantiles, quantiles_of
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
    first: np.ndarray, second: np.ndarray, outcomes: tuple[np.ndarray, np.ndarray]
) -> PairedDifference:
    """
    Return the difference of magnitudes over the cases in which both engaged and have a value.

    `first` and `second` are the (n,) values of both controllers, NaN where there is none. Negative
    values are in favour of the first controller: smaller is better for each quantity.
    """
    both = (outcomes[0] == ENGAGED) & (outcomes[1] == ENGAGED)
    differences = (np.abs(first) - np.abs(second))[both]
    differences = differences[~np.isnan(differences)]
    return PairedDifference(
        len(differences), quantiles_of(differences), median_interval(differences)
    )


def median_interval(values: np.ndarray) -> tuple[float, float] | None:
    """
    Return the interval of the median by the sign test, valid for every distribution.

    Its ends are the values of rank k and n + 1 - k, with the largest k for which P(Binomial(n,
    1/2) < k) is at most 2.5 %. Fewer than six values have none.
    """
    outside = (1.0 - CONFIDENCE) / 2.0
    runs = len(values)
    rank = _quantile_of_half(outside, runs) if runs else 0
    if rank < 1:
        return None
    ordered = np.sort(values)
    return float(ordered[rank - 1]), float(ordered[runs - rank])


def _quantile_of_half(probability: float, runs: int) -> int:
    """Return the smallest k with P(Binomial(runs, 1/2) <= k) of at least a probability."""
    # The same as scipy.stats.binom.ppf; scipy.stats takes long to import.
    rank = math.ceil(scipy.special.bdtrik(probability, runs, 0.5))
    below = rank > 0 and scipy.special.bdtr(rank - 1, runs, 0.5) >= probability
    return rank - 1 if below else rank
