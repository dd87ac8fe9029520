# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A stretch of a log, and the names of its torques."""

from dataclasses import dataclass

import numpy as np

from ddct_bringup.logs.log import SPEEDS
from ddct_plant.linear.names import Names

TORQUES = ('engine_torque', 'clutch_torque')
"""Names of C_m and C_f, which a log must have."""
LOAD = 'load_torque'
"""Name of C_load, which a log may have."""
SPEED_COLUMNS, TORQUE_COLUMNS = Names(SPEEDS), Names((*TORQUES, LOAD))
"""Names of the columns of speeds and torques."""


@dataclass(frozen=True, eq=False)
class Stretch:
    """A part of a log without a gap: n samples of the speeds, and the torques on a finer grid."""

    time_s: np.ndarray
    """Times of the samples in s, (n,)."""
    speeds: np.ndarray
    """Speeds w_m, w_p, w_r in rad/s, (n, 3), by SPEED_COLUMNS."""
    grid_s: np.ndarray
    """Times of the grid in s, (m,), in equal steps from before the first sample to after the
    last."""
    torques: np.ndarray
    """Torques C_m, C_f and the known part of C_load in N m on the grid, (m, 3), by
    TORQUE_COLUMNS."""
    second_differences: np.ndarray
    """Second differences of the torques in N m over a step of their own rows, (m, 3); 0 if
    held."""
    held: tuple[bool, ...]
    """Whether each torque is held until its next sample; the others are linear between samples."""
    load_known: bool
    """Whether C_load was measured; otherwise a constant is fitted to each stretch."""
    known_s: tuple[float, float]
    """First and last time in s at which all torques were measured."""

    def speed(self, name: str) -> np.ndarray:
        """Return one speed in rad/s, (n,), by its name in SPEEDS."""
        return self.speeds[:, SPEED_COLUMNS[name]]

    def torque(self, name: str) -> np.ndarray:
        """Return one torque in N m on the grid, (m,), by its name."""
        return self.torques[:, TORQUE_COLUMNS[name]]


def slip_of(speeds: np.ndarray) -> np.ndarray:
    """Return the slip w_m - w_p, (n,), of speeds (n, 3), or that of their residuals."""
    engine, shaft = SPEED_COLUMNS.places('engine_speed', 'shaft_speed')
    return speeds[:, engine] - speeds[:, shaft]
