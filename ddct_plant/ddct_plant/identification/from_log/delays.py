"""How late a log has each of its signals: which delays can be found, and what they cost."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ddct_plant.base.errors import DdctError
from ddct_plant.identification.from_log.model import Sampling, Stretch, residuals_of
from ddct_plant.identification.from_log.names import LOAD, TORQUES
from ddct_plant.measured.log import SPEEDS

REFERENCE = SPEEDS[0]
"""Its delay is not fitted: were all signals later by one time, no log would show it."""
DELAYED = (*SPEEDS[1:], *TORQUES, LOAD)
"""Signals whose delay against the reference a log can show."""
BEND_OF = 'bend_of_'
BENDS = tuple(f'{BEND_OF}{name}' for name in TORQUES)
"""
Shares of their second differences that the lines between the rows of torques leave out.

A torque that bends between its rows is not on the line between them. Averaged over time, a smooth
one is off by -1/12 of its second difference, one with a corner by 0 to -1/8, one whose rows are
means over their step by -1/8, one with all corners on rows by 0.
"""
BEND_SCALE = 0.1
DELAY_SCALE_S = 0.01
"""Size of a usual delay, by which the fit scales them."""
_FEWEST = 20
"""Samples of a stretch that is used, after what the delays cost."""


def sampling_of(values: Mapping[str, float], *, load_known: bool) -> Sampling:
    """
    Return delays in s by quantity, and bends, as the model takes them; what is not given is 0.

    Where C_load was not measured, what is known of it follows from w_r, and has its delay.
    """
    by_name = {name: values.get(name, 0.0) for name in (*SPEEDS, *TORQUES, LOAD)}
    if not load_known:
        by_name[LOAD] = by_name[SPEEDS[2]]
    return Sampling(
        tuple(by_name[name] for name in SPEEDS),
        tuple(by_name[name] for name in (*TORQUES, LOAD)),
        (*(values.get(name, 0.0) for name in BENDS), 0.0),
    )


def left_of(values: Mapping[str, float], stretch: Stretch) -> tuple[np.ndarray, np.ndarray]:
    """Return `residuals_of` parameters and delays by name."""
    return residuals_of(values, sampling_of(values, load_known=stretch.load_known), stretch)


def without_ends(stretches: Sequence[Stretch], values: Mapping[str, float]) -> list[Stretch]:
    """
    Return the stretches without the samples whose torques the log does not have.

    A torque that is late by d is only in the log d after the sample of a speed. Raise DdctError
    where nothing is left.
    """
    kept = []
    for each in stretches:
        shifts = sampling_of(values, load_known=each.load_known).shifts
        step = np.median(np.diff(each.time_s))
        first, last = each.known_s[0] - step, each.known_s[1] + step
        rows = (each.time_s + shifts.min() >= first) & (each.time_s + shifts.max() <= last)
        if rows.sum() >= _FEWEST:
            kept.append(replace(each, time_s=each.time_s[rows], speeds=each.speeds[rows]))
    if not kept:
        raise DdctError('the delays leave no stretch of the log: give a longer log')
    return kept
