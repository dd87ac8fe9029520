# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Differences between development and held-out cases, which show a controller that remembers.

Both sets are random samples of the same cases, so that an honest controller differs by chance.
"""

import math
from collections.abc import Sequence

import numpy as np
import scipy

from ddct_bringup.benchmark.outcomes import Columns, outcomes_in, successes_in
from ddct_bringup.benchmark.result_types import Gap
from ddct_bringup.campaign_report.printed_summary import MAIN
from ddct_bringup.campaign_report.statistics.outcome import CONFIDENCE
from ddct_bringup.verdict.state import ENGAGED

SUCCESS = 'success'
"""Name of the gap of the share of successful runs."""
OF_SHARES, OF_QUANTITIES = "Fisher's exact test", 'Mann-Whitney test'


def gaps_of(development: Columns, held_out: Columns, *, names: Sequence[str] = MAIN) -> list[Gap]:
    """
    Return the gap of the share of successes, and those of quantities of engaged runs.

    With m figures each is tested at 5 %/m (Bonferroni), so that an honest controller is marked in
    at most 5 % of the benchmarks.
    """
    tested: dict[str, tuple[float | None, float | None]] = {
        SUCCESS: _gap_of_shares(successes_in(development), successes_in(held_out))
    }
    for name in names:
        tested[name] = _gap_of_values(_engaged(development, name), _engaged(held_out, name))
    return [
        {
            'name': name,
            'p_value': p_value,
            'worse': worse,
            'differs': p_value is not None and p_value * len(tested) <= 1.0 - CONFIDENCE,
        }
        for name, (p_value, worse) in tested.items()
    ]


def _engaged(columns: Columns, name: str) -> np.ndarray:
    values = np.abs(columns[name][outcomes_in(columns) == ENGAGED])
    return np.asarray(values[~np.isnan(values)])


def _gap_of_shares(first: np.ndarray, second: np.ndarray) -> tuple[float, float]:
    """Return the p-value of two shares, and the probability that a second run is the worse."""
    table = [int(np.sum(each)) for each in (first, ~first, second, ~second)]
    worse = 0.5 + (float(np.mean(first)) - float(np.mean(second))) / 2.0
    return fisher_p_value(*table), worse


def fisher_p_value(a: int, b: int, c: int, d: int) -> float:
    """
    Return the two-sided p-value of Fisher's exact test of the table ((a, b), (c, d)).

    It is the probability of all tables with the same sums that are at most as probable.
    """
    least, most = max(0, a - d), min(a + b, a + c)
    chances = np.exp([_log_chance(each, a + b, c + d, a + c) for each in range(least, most + 1)])
    same = chances[a - least]
    return float(min(1.0, np.sum(chances[chances <= same * (1.0 + 1e-7)])))


def _log_chance(a: int, first: int, second: int, column: int) -> float:
    """Return the logarithm of the hypergeometric probability of a in the first row."""
    parts = (_log_choose(first, a), _log_choose(second, column - a))
    return sum(parts) - _log_choose(first + second, column)


def _log_choose(n: int, k: int) -> float:
    return math.lgamma(n + 1) - math.lgamma(k + 1) - math.lgamma(n - k + 1)


def _gap_of_values(first: np.ndarray, second: np.ndarray) -> tuple[float | None, float | None]:
    """
    Return the p-value of two samples, and the probability that a second value is the larger.

    Mann and Whitney 1947, by the normal distribution with ties; None without values.
    """
    if not len(first) or not len(second):
        return None, None
    both = np.concatenate([first, second])
    _, places, counts = np.unique(both, return_inverse=True, return_counts=True)
    ranks = (np.cumsum(counts) - (counts - 1) / 2.0)[places]
    n, m, total = len(first), len(second), len(both)
    larger = float(np.sum(ranks[n:])) - m * (m + 1) / 2.0
    ties = float(np.sum(counts**3 - counts)) / (total * (total - 1)) if total > 1 else 0.0
    variance = n * m * (total + 1 - ties) / 12.0
    if variance <= 0.0:
        return 1.0, 0.5
    distance = max(0.0, abs(larger - n * m / 2.0) - 0.5) / math.sqrt(variance)
    return float(min(1.0, 2.0 * scipy.special.ndtr(-distance))), larger / (n * m)
