# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rows and limits of what is so in every run of a case: slip, capacity, and engine torque."""

from dataclasses import dataclass

import numpy as np

from ddct_bringup.floor.dynamics.capacity import CapacityRange
from ddct_bringup.floor.dynamics.engine_laws import EngineLaw
from ddct_bringup.floor.dynamics.motion import Motion
from ddct_bringup.floor.lock import Lock

_BAND_SHARE = 0.01
"""Share of the band of a linear clutch that points keep clear of."""
_NODES = (0, 5)
"""Nodes of a period at which the capacity has its limits; it hardly differs between them."""
_LAST_SLIPS = 10
"""Number of steps before the lock at which the sign of the slip is a limit from the beginning."""


@dataclass(frozen=True, eq=False)
class Rows:
    """Inequalities rows z <= limits, with what a solver may know of them."""

    rows: np.ndarray
    """(m, columns)."""
    limits: np.ndarray
    """(m,)."""
    deferred: np.ndarray
    """Mask of those that seldom matter, (m,)."""
    margin: np.ndarray
    """Distance to the limits, (m,), that makes a point a run of the simulated plant too."""

    def __add__(self, other: 'Rows') -> 'Rows':
        """Return both, one after the other."""
        return Rows(
            np.vstack([self.rows, other.rows]),
            np.concatenate([self.limits, other.limits]),
            np.concatenate([self.deferred, other.deferred]),
            np.concatenate([self.margin, other.margin]),
        )


def clutch_rows(motion: Motion, capacity: CapacityRange) -> Rows:
    """
    Return the rows of plates that stick.

    They slip one way until the lock, and their capacity is between zero and its most. All but the
    last slips seldom matter.
    """
    slip = -motion.sign * motion.slip
    torque = motion.capacity[:, _NODES].reshape(-1, motion.columns.count)
    rows = [slip, -torque]
    limits = [np.zeros(len(slip) + len(torque))]
    if np.isfinite(capacity.most):
        rows.append(torque)
        limits.append(np.full(len(torque), capacity.most))
    every = np.concatenate(limits)
    deferred = np.ones(len(every), dtype=bool)
    deferred[max(len(slip) - _LAST_SLIPS, 0) : len(slip)] = False
    return Rows(np.vstack(rows), every, deferred, np.zeros(len(every)))


def band_rows(motion: Motion, lock: Lock, band_rad_s: float) -> Rows:
    """
    Return the rows of a linear clutch, which stays within the band from its lock on.

    They have a margin, as the load of the plant is not exactly that of a point.
    """
    after = motion.slip[lock.periods - 1 :]
    count = 2 * len(after)
    return Rows(
        np.vstack([after, -after]),
        np.full(count, band_rad_s),
        np.zeros(count, dtype=bool),
        np.full(count, _BAND_SHARE * band_rad_s),
    )


def _cut_rows(motion: Motion, per_slip: float) -> np.ndarray:
    """Return the rows of a torque cut that is at most `per_slip` times the slip at its step."""
    rows = -per_slip * motion.slip
    places = np.arange(len(rows))
    rows[places, motion.columns.engine.start + 1 + places] -= 1.0
    return np.asarray(rows)


def engine_rows(motion: Motion, law: EngineLaw) -> Rows:
    """Return the rows of the lines over w_m between which C_m is, and of the least w_m."""
    columns = motion.columns
    steps = columns.engine.stop - columns.engine.start
    rows = [np.zeros((0, columns.count))]
    if steps:
        speed = motion.engine_speed[:steps]
        torque = law.slope[:steps, np.newaxis] * speed
        torque[:, 0] += law.offset[:steps]
        torque[np.arange(steps), columns.engine.start + np.arange(steps)] += 1.0
        for offset, slope, side in law.lines:
            beyond = torque - slope[:steps, np.newaxis] * speed
            beyond[:, 0] -= offset[:steps]
            rows.append(side * beyond)
        if law.cut_per_slip:
            rows.append(_cut_rows(motion, law.cut_per_slip))
    limits = [np.zeros(sum(len(each) for each in rows))]
    if law.least_speed is not None:
        rows.append(-motion.engine_speed[:-1])
        limits.append(-law.least_speed[:-1])
    every = np.vstack(rows)
    return Rows(
        every, np.concatenate(limits), np.ones(len(every), dtype=bool), np.zeros(len(every))
    )
