# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Boundary of failure on a grid: the first failure along a line from its start outward."""

from dataclasses import dataclass

import numpy as np

from ddct_bringup.evaluation.share import FAILED, Share
from ddct_bringup.verdict.state import INVALID


@dataclass(frozen=True)
class BoundarySide:
    """Boundary of failure along a line, from its start to one end."""

    last_good: float | None
    """
    Last value up to which no run failed and all are valid; None where the start has a failure.
    """
    first_failure: float | None
    """First value at which a run failed; None where none did."""
    failed: Share | None
    """Failed runs among those at `first_failure`."""
    invalid: int
    """Number of invalid runs up to `first_failure`, or to the end of the line."""
    index: int | None
    """Index of the first failed run at `first_failure`."""
    state: str | None
    """State of that run."""


@dataclass(frozen=True)
class Boundary:
    """Boundaries of failure on a line over one key."""

    key: str
    nominal: float | None
    start: float
    others: dict[str, float]
    """Values of the grid's other numbers by key."""
    below: BoundarySide
    above: BoundarySide


def boundary_sides(
    values: np.ndarray, outcomes: np.ndarray, start: float, index: np.ndarray, states: np.ndarray
) -> tuple[BoundarySide, BoundarySide]:
    """
    Return the boundaries below and above the start of a line.

    `values`, `outcomes`, `index` and `states` of the runs on the line are (n,); `start` is one of
    the values.
    """
    below, above = (
        _side(values, outcomes, distance, index, states)
        for distance in (start - values, values - start)
    )
    return below, above


def _side(
    values: np.ndarray,
    outcomes: np.ndarray,
    distance: np.ndarray,
    index: np.ndarray,
    states: np.ndarray,
) -> BoundarySide:
    """Return the boundary along (n,) distances from the start; those behind it are negative."""
    ahead = distance >= 0.0
    failure = _least(distance, ahead & (outcomes == FAILED))
    doubt = _least(distance, ahead & (outcomes == INVALID))
    good = ahead & (distance < min(failure, doubt))
    last_good = float(values[np.argmax(np.where(good, distance, -1.0))]) if good.any() else None
    invalid = int(np.sum(ahead & (distance <= failure) & (outcomes == INVALID)))
    if np.isinf(failure):
        return BoundarySide(last_good, None, None, invalid, None, None)
    there = distance == failure
    failed = np.flatnonzero(there & (outcomes == FAILED))
    first = failed[0]
    return BoundarySide(
        last_good,
        float(values[first]),
        Share(len(failed), int(np.sum(there))),
        invalid,
        int(index[first]),
        str(states[first]),
    )


def _least(distance: np.ndarray, chosen: np.ndarray) -> float:
    """Return the smallest of the chosen distances, infinite without one."""
    return float(np.min(distance, where=chosen, initial=np.inf))
