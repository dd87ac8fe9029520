# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Selection of the fitted numbers that a log does not determine."""

import math
from collections.abc import Sequence

import numpy as np

from ddct_bringup.identification.from_log.delays import BEND_OF, DELAY_SCALE_S, DELAYED
from ddct_bringup.identification.from_log.problem import DAMPINGS

DETERMINED = 0.25
"""Largest relative standard deviation of a determined parameter."""
DAMPING_DETERMINED = 0.05
"""Largest standard deviation of a determined damping, over the torque per speed of the log."""
DELAY_DETERMINED_S = 0.005
"""Largest standard deviation of a determined delay, in s."""
PULLED = 0.4
"""Largest shift of a number by the noise of the torques, over the limits above."""


def not_determined(free: Sequence[str], std: np.ndarray, moved: np.ndarray) -> list[str]:
    """
    Return the names that are too uncertain, or shifted too far for a linear correction.

    `std` and `moved` are in the units of the fit. If there are delays among them, only those are
    returned: a parameter may be uncertain only because a delay is.
    """
    excess = np.maximum(std, moved / PULLED) / np.array([_most(name) for name in free])
    weak = [name for name, each in zip(free, excess, strict=True) if each > 1.0]
    return [name for name in weak if name in DELAYED] or weak


def _most(name: str) -> float:
    """Return the largest standard deviation of a determined number, in the units of a fit."""
    if name.startswith(BEND_OF):
        return math.inf
    if name in DELAYED:
        return DELAY_DETERMINED_S / DELAY_SCALE_S
    return DAMPING_DETERMINED if name in DAMPINGS else DETERMINED
