"""Search of the calibration: over the end of the score window, the two kinds of PI, and starts."""

import itertools
import math
from collections.abc import Callable, Sequence

from ddct_bringup.reproduction.calibration.parameters import BASE, DURATION_S, TARGETS
from ddct_bringup.reproduction.calibration.problem import Fit, Problem, fit
from ddct_plant.base.errors import DdctError

Progress = Callable[[str], None]

_SLOWEST_S = BASE.control_start_s + max(row['engagement_time_s'] for row in TARGETS.values())
WINDOW_ENDS_S = tuple(
    tenths / 10.0 for tenths in range(math.ceil(10.0 * _SLOWEST_S), round(10.0 * DURATION_S) + 1)
)
"""Tenths of a second from the end of the slowest printed engagement to the end of the run."""

STARTS = tuple(
    (*torques, rise_end, 105.0, *gains)
    for torques, rise_end, gains in itertools.product(
        ((5.0, 300.0), (40.0, 250.0)),
        (0.53, 0.40),
        ((0.10, 0.02), (0.02, 0.12)),  # K_p and K_i: mostly proportional, mostly integral
    )
)
"""Start values for the window that is chosen; the first two serve every window."""


def search(progress: Progress) -> tuple[list[Fit], list[Fit]]:
    """
    Return the best optimum of each kind of PI for each window end, and one from each of STARTS.

    First over the window ends, each from two starts; then from all starts for the window of the
    lowest objective of any stable PI loop.
    """
    windows: list[Fit] = []
    for end in WINDOW_ENDS_S:
        progress(f'score window to {end:g} s')
        windows += _one_of_each_kind([fit(Problem(end), x) for x in STARTS[:2]])
    chosen_window = lowest_stable(windows).problem
    starts = []
    for number, start in enumerate(STARTS, 1):
        progress(f'start {number} of {len(STARTS)} for the window to the chosen end')
        starts.append(fit(chosen_window, start))
    return windows, starts


def lowest_stable(optima: Sequence[Fit]) -> Fit:
    """Return that of the lowest objective among stable PI loops; raise DdctError without one."""
    stable = [one for one in optima if one.pi_stable]
    if not stable:
        raise DdctError(f'none of {len(optima)} fits has a stable PI loop: narrow the bounds')
    return min(stable, key=lambda one: one.objective)


def _one_of_each_kind(optima: Sequence[Fit]) -> list[Fit]:
    best: dict[str, Fit] = {}
    for one in sorted(optima, key=lambda one: one.objective):
        best.setdefault(one.pi_kind, one)
    return [best[kind] for kind in sorted(best, reverse=True)]
