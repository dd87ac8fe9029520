# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Delays of the signals of a log: which of them are identifiable, and the samples they cost."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ddct_bringup.identification.from_log.model import Sampling, residuals_of
from ddct_bringup.identification.from_log.stretch import LOAD, TORQUES, Stretch
from ddct_bringup.logs.log import SPEEDS
from ddct_plant.base.errors import DdctError

REFERENCE = SPEEDS[0]
"""Signal whose delay is not fitted: a common delay of all signals is not identifiable."""
DELAYED = (*SPEEDS[1:], *TORQUES, LOAD)
"""Signals whose delay relative to the reference is identifiable."""
BEND_OF = 'bend_of_'
"""Prefix of the name of a bend."""
BENDS = tuple(f'{BEND_OF}{name}' for name in TORQUES)
"""
Names of the bends: shares of the torques' second differences that linear interpolation misses.

A torque that bends between its rows is not on the line between them. Averaged over time, the error
of a smooth torque is -1/12 of its second difference, of one with a corner 0 to -1/8, of one whose
rows are means over their step -1/8, of one with all corners on rows 0.
"""
BEND_SCALE = 0.1
"""Size of a usual bend, which scales bends in the fit."""
DELAY_SCALE_S = 0.01
"""Size of a usual delay in s, which scales delays in the fit."""
_FEWEST = 20
"""Fewest samples of a used stretch, without the samples that the delays cost."""


def sampling_of(values: Mapping[str, float], *, load_known: bool) -> Sampling:
    """
    Return the delays in s and the bends of `values` in the form of the model; missing ones are 0.

    Where C_load was not measured, its known part is computed from w_r and has the delay of w_r.
    """
    by_name = {name: values.get(name, 0.0) for name in (*SPEEDS, *TORQUES, LOAD)}
    if not load_known:
        by_name[LOAD] = by_name[SPEEDS[2]]
    return Sampling(
        tuple(by_name[name] for name in SPEEDS),
        tuple(by_name[name] for name in (*TORQUES, LOAD)),
        (*(values.get(name, 0.0) for name in BENDS), 0.0),
    )


def residuals_by_name(
    values: Mapping[str, float], stretch: Stretch
) -> tuple[np.ndarray, np.ndarray]:
    """Return the residuals and nuisances of `residuals_of` for parameters and delays by name."""
    return residuals_of(values, sampling_of(values, load_known=stretch.load_known), stretch)


def without_ends(stretches: Sequence[Stretch], values: Mapping[str, float]) -> list[Stretch]:
    """
    Return the stretches without the samples whose torques are not in the log.

    A torque with the delay d is in the log d after the sample of a speed. Raise DdctError when no
    stretch is left.
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
