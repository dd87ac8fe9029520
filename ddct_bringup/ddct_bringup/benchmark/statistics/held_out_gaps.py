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

from ddct_bringup.benchmark.statistics.case_figures import FIGURES, LEVEL, CaseFigures

METHOD = 'van Elteren test, one-sided'


@dataclass(frozen=True)
class FigureGap:
    """Difference of one figure between development and held-out cases."""

    name: str
    p_value: float | None
    """Probability that held-out runs are so much worse by chance; None without values."""
    worse: float | None
    """Probability that a held-out run is worse than one of development; 0.5 where alike."""
    null: int
    """Number of successes left out, since they have no value."""

    @property
    def differs(self) -> bool:
        """Whether the gap is beyond chance, with all figures taken together (Bonferroni)."""
        return self.p_value is not None and self.p_value * len(FIGURES) <= LEVEL


def gaps_of(
    development: tuple[CaseFigures, Sequence[str] | np.ndarray],
    held_out: tuple[CaseFigures, Sequence[str] | np.ndarray],
) -> list[FigureGap]:
    """Return the gap of each figure; both sets of cases come with the scenario of each case."""
    sets = [(each, np.asarray(scenarios)) for each, scenarios in (development, held_out)]
    names = np.unique(np.concatenate([scenarios for _, scenarios in sets]))
    found: list[FigureGap] = []
    for place, figure in enumerate(FIGURES):
        strata = [
            tuple(_values(each, place, scenarios == name) for each, scenarios in sets)
            for name in names
        ]
        p_value, worse = van_elteren(strata)
        null = sum(int(np.sum(each.without_value[place])) for each, _ in sets)
        found.append(FigureGap(figure.name, p_value, worse, null))
    return found


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
    distance = variance = pairs = 0.0
    for first, second in strata:
        n, m, total = len(first), len(second), len(first) + len(second)
        if not n or not m:
            continue
        _, places, counts = np.unique(
            np.concatenate([first, second]), return_inverse=True, return_counts=True
        )
        ranks = (np.cumsum(counts) - (counts - 1) / 2.0)[places]
        ties = float(np.sum(counts**3 - counts)) / (total * (total - 1))
        distance += (float(np.sum(ranks[n:])) - m * (total + 1) / 2.0) / (total + 1)
        variance += n * m * (total + 1 - ties) / (12.0 * (total + 1) ** 2)
        pairs += n * m / (total + 1)
    if not pairs:
        return None, None
    if variance <= 0.0:
        return 1.0, 0.5
    return math.erfc(distance / math.sqrt(2.0 * variance)) / 2.0, 0.5 + distance / pairs
