"""Where failure begins: the first value on the way out from the nominal one."""

from dataclasses import dataclass

import numpy as np

from ddct_bringup.campaign_report.outcome import FAILED
from ddct_bringup.verdict.state import ENGAGED


@dataclass(frozen=True)
class WayOut:
    """What happens on the way from the start to one end of the range."""

    held_to: float | None
    """The last value before the first failure, or the end of the range; None where none held."""
    first_failure: float | None
    """The first value at which not every run is engaged; None where there is none."""
    row: int | None
    """Position of a run there: the first failed one, the first invalid one without any."""
    lost: int = 0
    """How many runs there are not engaged."""
    runs: int = 0
    """How many runs there are at that value."""


@dataclass(frozen=True)
class FirstFailures:
    """The ways out of one varied quantity."""

    below: WayOut
    above: WayOut


def first_failures(values: np.ndarray, outcomes: np.ndarray, start: float) -> FirstFailures:
    """
    Return the first failures over (n,) values of one quantity, going out from `start`.

    A value holds when all its runs are engaged. An invalid run holds nothing.
    """
    return FirstFailures(
        below=_way(values, outcomes, start - values),
        above=_way(values, outcomes, values - start),
    )


def _way(values: np.ndarray, outcomes: np.ndarray, distance: np.ndarray) -> WayOut:
    """Return the way along (n,) distances from the start; those below zero are not on it."""
    lost = np.where((distance >= 0.0) & (outcomes != ENGAGED), distance, np.inf)
    first = float(lost.min())
    held = np.where((distance >= 0.0) & (distance < first), distance, -np.inf)
    held_to = None if np.isinf(held).all() else float(values[held.argmax()])
    if np.isinf(first):
        return WayOut(held_to, None, None)
    rows = np.flatnonzero(lost == first)
    row = int(max(rows, key=lambda each: (outcomes[each] == FAILED, -each)))
    runs = int(np.sum(distance == first))
    return WayOut(held_to, float(values[row]), row, len(rows), runs)
