# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Paired dominance: one controller is better than another one, beyond chance, and nowhere worse.

A and B are compared in each case and figure. A is better where it is below B by more than 5 % of
B and by more than the least difference of the figure. For figures, which are not negative, 5 % of
B is 5 % of the larger of both, so that the rule is the same for A and for B. A failure is worse
than any success, and two failures tie.

A figure that no success of the two has is null by the case, as the response without a demand: the
case is then left out for that figure. If the success of one has the figure and that of the other
does not, the one without it is the worse: a run cannot remove its figure to its advantage.

All ordered pairs of controllers share the level. Among thirty equal controllers, of which each is
tested at 5 %, one is nearly always dominated.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np

from ddct_bringup.evaluation.case_figures import FIGURES, LEVEL, CaseFigures

RELATIVE_DIFFERENCE = 0.05
"""Part of the larger value by which two values have to differ."""
ROUNDING = 1e-9
"""Relative difference of equal values: kernels of linear algebra differ by less."""


@dataclass(frozen=True)
class FigureComparison:
    """One figure of two controllers, case by case."""

    better: int
    """Number of cases in which the first one is better."""
    worse: int
    """Number of cases in which it is worse."""
    left_out: int
    """Number of cases left out, since the figure is null by the case."""
    median_difference: float | None
    """
    Median of the first value less the second, over the cases not left out, in the figure's unit.

    It is None where failures of one controller alone decide it, and 0 without a case.
    """
    worse_in_median: bool
    """Whether the median difference is above zero, failures included."""

    @property
    def p_better(self) -> float:
        """p-value of the one-sided sign test that the first one is better; ties do not count."""
        return sign_test(self.better, self.worse)

    @property
    def p_worse(self) -> float:
        """p-value of the one-sided sign test that the first one is worse."""
        return sign_test(self.worse, self.better)


@dataclass(frozen=True)
class PairedComparison:
    """All figures of two controllers on the same cases."""

    cases: int
    figures: dict[str, FigureComparison]
    """Five figures by key."""

    def dominates(self, *, among: int) -> bool:
        """
        Return whether the first controller dominates the second, where so many are compared.

        One figure is significantly better, at `level_among` them all. No figure is worse: neither
        at 5 % of its own nor in its median difference.
        """
        level = level_among(among)
        figures = self.figures.values()
        return any(each.p_better <= level for each in figures) and not any(
            each.p_worse <= LEVEL or each.worse_in_median for each in figures
        )


def level_among(controllers: int) -> float:
    """
    Return the level of one figure of one ordered pair of controllers.

    It is 5 % divided by the numbers of figures and of ordered pairs (Bonferroni), so that any of
    these controllers is dominated in at most 5 % of benchmarks where all are equal.
    """
    return LEVEL / (len(FIGURES) * controllers * (controllers - 1))


def compare(first: CaseFigures, second: CaseFigures) -> PairedComparison:
    """
    Return the comparison of two controllers on the same cases in the same order.

    Raise ValueError where they have another number of cases.
    """
    if first.cases != second.cases:
        raise ValueError(f'{first.cases} cases are not the {second.cases} of the other controller')
    ours, theirs = first.failures_worst, second.failures_worst
    null = (first.without_value | second.without_value) & ~(
        np.isfinite(ours) | np.isfinite(theirs)
    )
    ours, theirs = (np.where(np.isnan(each), np.inf, each) for each in (ours, theirs))
    with np.errstate(invalid='ignore'):
        same = np.isclose(ours, theirs, rtol=ROUNDING, atol=0.0)
        difference = np.where(same, 0.0, ours - theirs)
        least = np.array([[each.least_difference] for each in FIGURES])
        larger = np.maximum(ours, theirs)
        margin = np.where(np.isinf(larger), least, np.maximum(least, RELATIVE_DIFFERENCE * larger))
    better, worse = (np.sum(~null & (each > margin), axis=1) for each in (-difference, difference))
    found: dict[str, FigureComparison] = {}
    for place, figure in enumerate(FIGURES):
        median = _median(difference[place][~null[place]])
        found[figure.name] = FigureComparison(
            int(better[place]),
            int(worse[place]),
            int(np.sum(null[place])),
            median if math.isfinite(median) else None,
            median > 0.0,
        )
    return PairedComparison(first.cases, found)


def dominators_of(controllers: Mapping[str, CaseFigures]) -> dict[str, tuple[str, ...]]:
    """
    Return for each of the controllers on the same cases those that dominate it.

    If all are equal, any of them is dominated in at most 5 % of benchmarks.
    """
    among = len(controllers)
    return {
        name: tuple(
            other
            for other, theirs in controllers.items()
            if other != name and compare(theirs, ours).dominates(among=among)
        )
        for name, ours in controllers.items()
    }


@cache
def sign_test(more: int, fewer: int) -> float:
    """Return P(X >= more) for X binomial of more + fewer trials with the chance 1/2."""
    # That of scipy.stats.binom, whose import takes half a second.
    from scipy.special import bdtrc

    return float(bdtrc(more - 1, more + fewer, 0.5))


def _median(values: np.ndarray) -> float:
    """Return the median of (n,) values; 0 of none, or between minus infinity and infinity."""
    if not len(values):
        return 0.0
    ordered = np.sort(values)
    lower, upper = float(ordered[(len(values) - 1) // 2]), float(ordered[len(values) // 2])
    return 0.0 if math.isinf(lower) and lower == -upper else (lower + upper) / 2.0
