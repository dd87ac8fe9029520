# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Distribution of a quantity over the engaged runs, and its worst cases."""

from dataclasses import dataclass

import numpy as np

from ddct_bringup.verdict.state import ENGAGED, INVALID
from ddct_plant.files.json_records import Inline

_PROBABILITIES = (0.05, 0.50, 0.95)
"""Probabilities of P5, P50 and P95."""
ONE_IN = 20
"""Inverse of the share of worst runs, 5 %; with fewer engaged runs there is no CVaR."""


@dataclass(frozen=True)
class Quantiles:
    """Quantiles P5, P50 and P95; None without a value."""

    p5: float | None
    p50: float | None
    p95: float | None


@dataclass(frozen=True)
class RunValue:
    """Value of a quantity in one run, with the run's index and state."""

    value: float
    index: int
    """Index of the run; in a benchmark the number of its case."""
    state: str


@dataclass(frozen=True)
class QuantitySummary:
    """Distribution of a quantity over the engaged runs of a group, and its worst cases."""

    unit: str
    with_value: int
    """Number of engaged runs that have a value."""
    quantiles: Inline[Quantiles]
    """Quantiles P5, P50 and P95 of the values of engaged runs, with signs."""
    cvar_engaged: float | None
    """Mean magnitude of the worst 5 % of the engaged runs with a value, None for fewer than 20."""
    worst_engaged: RunValue | None
    """Engaged run with the largest magnitude, the first of equals; None without a value."""
    worst: RunValue | None
    """Valid run with the largest magnitude, failed ones included."""


def spread_of(
    unit: str, values: np.ndarray, outcomes: np.ndarray, index: np.ndarray, states: np.ndarray
) -> QuantitySummary:
    """
    Return the statistics of (n,) values, NaN where there is none.

    `outcomes`, `index` and `states` are those of the runs, (n,) each. Only engaged runs with a
    value take part in quantiles and CVaR. Failed runs are neither included nor ranked: their
    number is a separate result.
    """
    engaged = outcomes == ENGAGED
    taken = values[engaged & ~np.isnan(values)]
    magnitudes = np.abs(values)

    def worst(among: np.ndarray) -> RunValue | None:
        place = _largest(np.where(among, magnitudes, np.nan))
        if place is None:
            return None
        return RunValue(float(values[place]), int(index[place]), str(states[place]))

    return QuantitySummary(
        unit=unit,
        with_value=len(taken),
        quantiles=quantiles_of(taken),
        cvar_engaged=conditional_value_at_risk(np.abs(taken)) if len(taken) >= ONE_IN else None,
        worst_engaged=worst(engaged),
        worst=worst(outcomes != INVALID),
    )


def quantiles_of(values: np.ndarray) -> Quantiles:
    """Return P5, P50 and P95 of (n,) values with linear interpolation (Hyndman-Fan 7)."""
    if not len(values):
        return Quantiles(None, None, None)
    return Quantiles(*np.quantile(values, _PROBABILITIES).tolist())


def conditional_value_at_risk(values: np.ndarray) -> float:
    """
    Return the mean of the largest n / 20 of (n,) values, n >= 20.

    Where that is no whole number, the next value has the remaining fraction as its weight
    (Rockafellar and Uryasev 2002, Proposition 8).
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
