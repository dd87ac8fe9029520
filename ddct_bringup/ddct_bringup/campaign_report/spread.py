"""How a quantity spreads over the engaged runs, and its worst case."""

from dataclasses import dataclass

import numpy as np

from ddct_bringup.verdict.state import ENGAGED, INVALID

QUANTILES = {'p5': 0.05, 'p50': 0.50, 'p95': 0.95}
"""By name."""
ONE_IN = 20
"""The worst runs are one in so many: 5 %. Of fewer engaged runs there is no such part."""


@dataclass(frozen=True)
class Spread:
    """Figures of one quantity over some runs; runs by their position among them."""

    engaged: int
    """How many runs are engaged."""
    with_value: int
    """How many of those have a value."""
    quantiles: dict[str, float | None]
    """P5, P50 and P95 of these, with their signs; None without a value."""
    cvar: float | None
    """Mean magnitude of the worst 5 % of these, None of fewer than 20."""
    worst_engaged: int | None
    """The engaged run with the largest magnitude, the first of equals."""
    worst: int | None
    """The same of the valid runs, failed ones too."""


def spread_of(values: np.ndarray, outcomes: np.ndarray) -> Spread:
    """
    Return the figures of (n,) values, NaN where there is none, with the runs' outcomes.

    Only engaged runs with a value take part in quantiles and CVaR. No run that failed does, and
    none is ranked: how many there are is a figure of its own.
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


def quantiles_of(values: np.ndarray) -> dict[str, float | None]:
    """Return P5, P50 and P95 of (n,) values, between two of them by a line (Hyndman-Fan 7)."""
    if not len(values):
        return dict.fromkeys(QUANTILES)
    found = np.quantile(values, [*QUANTILES.values()])
    return dict(zip(QUANTILES, found.tolist(), strict=True))


def conditional_value_at_risk(values: np.ndarray) -> float:
    """
    Return the mean of the largest n / 20 of (n,) values, n >= 20.

    Where that is no whole number, the next value counts with the rest of it (Rockafellar and
    Uryasev 2002, Proposition 8).
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
