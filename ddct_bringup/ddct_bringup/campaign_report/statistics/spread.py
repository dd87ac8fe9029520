# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Distribution of a quantity over the engaged runs, and its worst case."""

from dataclasses import dataclass

import numpy as np

from ddct_bringup.verdict.state import ENGAGED, INVALID

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
class Spread:
    """Statistics of one quantity over some runs; runs by their position among them."""

    engaged: int
    """Number of engaged runs."""
    with_value: int
    """Number of engaged runs that have a value."""
    quantiles: Quantiles
    """
    Quantiles P5, P50 and P95 of the values of engaged runs, with signs; None without a value.
    """
    cvar: float | None
    """Mean magnitude of the worst 5 % of the engaged runs with a value, None for fewer than 20."""
    worst_engaged: int | None
    """Position of the engaged run with the largest magnitude, the first of equals."""
    worst: int | None
    """Position of the valid run with the largest magnitude, failed ones included."""


def spread_of(values: np.ndarray, outcomes: np.ndarray) -> Spread:
    """
    Return the statistics of (n,) values, NaN where there is none, with the runs' outcomes.

    Only engaged runs with a value take part in quantiles and CVaR. Failed runs are neither
    included nor ranked: their number is a separate result.
    """
    engaged = outcomes == ENGAGED
    taken = values[engaged & ~np.isnan(values)]
    magnitudes = np.abs(values)
    return Spread(
        engaged=int(np.sum(engaged)),
        with_value=len(taken),
        quantiles=quantiles_of(taken),
        cvar=conditional_value_at_risk(np.abs(taken)) if len(taken) >= ONE_IN else None,
        worst_engaged=_largest(np.where(engaged, magnitudes, np.nan)),
        worst=_largest(np.where(outcomes == INVALID, np.nan, magnitudes)),
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
