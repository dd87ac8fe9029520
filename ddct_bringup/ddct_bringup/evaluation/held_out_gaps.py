# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Gaps between development and held-out cases, which show a controller that remembers.

Both sets are random samples of the same cases in each scenario, so that an honest controller
differs by chance alone. The ranks within scenarios are compared, since a figure differs more from
one scenario to another than within one. A failure has the last rank, so that fewer successes are a
gap in every figure, most of all in one that is equal in most runs, as releases are.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ddct_bringup.evaluation.case_figures import FIGURES, LEVEL, CaseFigures

METHOD = 'van Elteren test, one-sided'


@dataclass(frozen=True)
class Gap:
    """Difference of one figure between development and held-out cases."""

    name: str
    p_value: float | None
    """Probability that held-out runs are so much worse by chance; None without values."""
    worse: float | None
    """
    Probability that a held-out run is worse than one of development; 0.5 where they are alike.
    """
    left_out: int
    """Number of successes left out, since they have no value."""
    differs: bool
    """Whether it is beyond chance, with all figures taken together (Bonferroni)."""


def gaps_of(
    development: tuple[CaseFigures, Sequence[str] | np.ndarray],
    held_out: tuple[CaseFigures, Sequence[str] | np.ndarray],
) -> tuple[Gap, ...]:
    """Return the gap of each figure; both sets of cases come with the scenario of each case."""
    sets = [(each, np.asarray(scenarios)) for each, scenarios in (development, held_out)]
    names = np.unique(np.concatenate([scenarios for _, scenarios in sets]))
    found: list[Gap] = []
    for place, figure in enumerate(FIGURES):
        strata = [
            tuple(_values(each, place, scenarios == name) for each, scenarios in sets)
            for name in names
        ]
        p_value, worse = van_elteren(strata)
        left_out = sum(int(np.sum(each.without_value[place])) for each, _ in sets)
        differs = p_value is not None and p_value * len(FIGURES) <= LEVEL
        found.append(Gap(figure.name, p_value, worse, left_out, differs))
    return tuple(found)


def _values(figures: CaseFigures, place: int, chosen: np.ndarray) -> np.ndarray:
    values = figures.failures_worst[place][chosen]
    return np.asarray(values[~np.isnan(values)])


def van_elteren(
    strata: Iterable[tuple[np.ndarray, ...]],
) -> tuple[float | None, float | None]:
    """
    Return the p-value of larger values in second samples, and how probable a larger one is.

    Each stratum has two samples of any number of values, infinite ones included. Those of one
    sample alone are left out; without any other both results are None.

    With N values in a stratum, m of them in the second sample with the sum R of mid-ranks, and
    ties of t values, the statistic is the sum of (R - m (N + 1) / 2) / (N + 1). Its variance
    is the sum of n m / (12 (N + 1)^2) (N + 1 - sum(t^3 - t) / (N (N - 1))), and the p-value that
    of a normal distribution. P. van Elteren 1960, On the combination of independent two sample
    tests of Wilcoxon; E. L. Lehmann 1975, Nonparametrics, pages 132 to 141.
    """
    # Not scipy.stats, whose import takes half a second.
    from scipy.special import ndtr

    distance = variance = pairs = 0.0
    for first, second in strata:
        n, m, total = len(first), len(second), len(first) + len(second)
        if not n or not m:
            continue
        every = np.concatenate([first, second])
        _, places, ties = np.unique(every, return_inverse=True, return_counts=True)
        ranks = (np.cumsum(ties) - (ties - 1) / 2.0)[places]
        distance += (float(np.sum(ranks[n:])) - m * (total + 1) / 2.0) / (total + 1)
        tied = float(np.sum(ties**3 - ties)) / (total**3 - total)
        variance += n * m * (1.0 - tied) / (12.0 * (total + 1))
        pairs += n * m / (total + 1)
    if not pairs:
        return None, None
    if variance <= 0.0:
        return 1.0, 0.5
    return float(ndtr(-distance / math.sqrt(variance))), 0.5 + float(distance / pairs)
