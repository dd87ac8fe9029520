# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Boundary of failure on a grid: the first failure along a line from its start outward."""

from dataclasses import dataclass

import numpy as np

from ddct_bringup.campaign_report.statistics.outcome import FAILED
from ddct_bringup.verdict.state import INVALID


@dataclass(frozen=True)
class FailureBoundary:
    """Boundary of failure along a line, from its start to one end."""

    last_good_value: float | None
    """
    Last value up to which no run failed and all are valid; None where the start has a failure.
    """
    first_failure: float | None
    """First value at which a run failed; None where none did."""
    row: int | None
    """Position of the first failed run at `first_failure`."""
    failed: int = 0
    """Number of failed runs at `first_failure`."""
    runs: int = 0
    """Number of runs at `first_failure`."""
    invalid: int = 0
    """Number of invalid runs up to `first_failure`, or to the end of the line."""


def boundaries(
    values: np.ndarray, outcomes: np.ndarray, start: float
) -> dict[str, FailureBoundary]:
    """
    Return the boundaries `below` and `above` the start of a line.

    `values` and `outcomes` of the runs on the line are (n,); `start` is one of the values.
    """
    return {
        'below': _boundary(values, outcomes, start - values),
        'above': _boundary(values, outcomes, values - start),
    }


def _boundary(values: np.ndarray, outcomes: np.ndarray, distance: np.ndarray) -> FailureBoundary:
    """Return the boundary along (n,) distances from the start; those behind it are negative."""
    ahead = distance >= 0.0
    failure = _least(distance, ahead & (outcomes == FAILED))
    doubt = _least(distance, ahead & (outcomes == INVALID))
    good = ahead & (distance < min(failure, doubt))
    last_good_value = (
        float(values[np.argmax(np.where(good, distance, -1.0))]) if good.any() else None
    )
    invalid = int(np.sum(ahead & (distance <= failure) & (outcomes == INVALID)))
    if np.isinf(failure):
        return FailureBoundary(last_good_value, None, None, invalid=invalid)
    there = distance == failure
    failed = np.flatnonzero(there & (outcomes == FAILED))
    first = float(values[failed[0]])
    return FailureBoundary(
        last_good_value, first, int(failed[0]), len(failed), int(np.sum(there)), invalid
    )


def _least(distance: np.ndarray, chosen: np.ndarray) -> float:
    """Return the smallest of the chosen distances, infinite without one."""
    return float(np.min(distance, where=chosen, initial=np.inf))
