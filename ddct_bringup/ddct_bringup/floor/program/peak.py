# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The linear program of a least peak, and which of its rows seldom matter."""

import numpy as np

from ddct_bringup.floor.program.linear_program import LinearProgram
from ddct_plant.base.timebase import PERIOD_S

MOST_PEAK = 1e6
"""Upper bound of a peak in its unit; every run is below."""
_SETTLED_S = 0.5
"""Time in s after the lock from which a peak is seldom."""


def peak_program(
    rows: np.ndarray,
    offset: np.ndarray,
    limiting: np.ndarray,
    limits: np.ndarray,
    equal_rows: np.ndarray,
    equal_values: np.ndarray,
    low: np.ndarray,
    high: np.ndarray,
    *,
    one_sided: bool = False,
) -> LinearProgram:
    """
    Return the program of the least largest |rows x + offset| over x (n,) in a box.

    The points keep limiting x <= limits and the equations. The last variable is the peak, and the
    first rows are those of the peak. With `one_sided` it is the largest value without its sign.
    """
    one = np.ones((len(rows), 1))
    sides = [(rows, offset)] if one_sided else [(rows, offset), (-rows, -offset)]
    return LinearProgram(
        cost=np.append(np.zeros(rows.shape[1]), 1.0),
        constant=0.0,
        rows=np.block(
            [[side, -one] for side, _ in sides] + [[limiting, np.zeros((len(limiting), 1))]]
        ),
        limits=np.concatenate([*(-given for _, given in sides), limits]),
        equal_rows=np.hstack([equal_rows, np.zeros((len(equal_rows), 1))]),
        equal_values=equal_values,
        low=np.append(low, 0.0),
        high=np.append(high, MOST_PEAK),
        peaks=len(sides) * len(rows),
    )


def late_peaks(count: int, lock_time_s: float) -> np.ndarray:
    """
    Return the mask of the rows of a peak that are long after the lock, (2 count,).

    There is a row for each period from control start on, in both signs.
    """
    late = np.arange(count) * PERIOD_S > lock_time_s + _SETTLED_S
    return np.concatenate([late, late])
