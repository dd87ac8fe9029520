"""Which numbers of a fit a log determines."""

import math
from collections.abc import Sequence

import numpy as np

from ddct_plant.identification.from_log.delays import BEND_OF, DELAY_SCALE_S, DELAYED
from ddct_plant.identification.from_log.problem import DAMPINGS

DETERMINED = 0.25
"""Largest relative standard deviation of a parameter that a log determines."""
DAMPING_DETERMINED = 0.05
"""The same of a damping, over the torque per speed of the log."""
DELAY_DETERMINED_S = 0.005
"""The same of a delay, in s."""
PULLED = 0.4
"""Share of these by which the noise of the torques may move a number."""


def not_determined(free: Sequence[str], std: np.ndarray, moved: np.ndarray) -> list[str]:
    """
    Return the names that are too uncertain, or pulled too far to be moved back on a line.

    `std` and `moved` are in the units of the fit. Where the names are of delays and parameters,
    it is the delays alone: a parameter may be uncertain only because a delay is.
    """
    excess = np.maximum(std, moved / PULLED) / np.array([_most(name) for name in free])
    weak = [name for name, each in zip(free, excess, strict=True) if each > 1.0]
    return [name for name in weak if name in DELAYED] or weak


def _most(name: str) -> float:
    """Return the largest deviation of what counts as determined, in the units of a fit."""
    if name.startswith(BEND_OF):
        return math.inf
    if name in DELAYED:
        return DELAY_DETERMINED_S / DELAY_SCALE_S
    return DAMPING_DETERMINED if name in DAMPINGS else DETERMINED
