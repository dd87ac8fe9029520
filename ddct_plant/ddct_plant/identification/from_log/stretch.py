# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A stretch of a log, and the names of its torques."""

from dataclasses import dataclass

import numpy as np

TORQUES = ('engine_torque', 'clutch_torque')
"""Names of C_m and C_f, which a log must have."""
LOAD = 'load_torque'
"""Name of C_load, which a log may have."""


@dataclass(frozen=True, eq=False)
class Stretch:
    """A part of a log without a gap: n samples of the speeds, and the torques on a finer grid."""

    time_s: np.ndarray
    """Times of the samples in s, (n,)."""
    speeds: np.ndarray
    """Speeds w_m, w_p, w_r in rad/s, (n, 3)."""
    grid_s: np.ndarray
    """Times of the grid in s, (m,), in equal steps from before the first sample to after the
    last."""
    torques: np.ndarray
    """Torques C_m, C_f and the known part of C_load in N m on the grid, (m, 3)."""
    bends: np.ndarray
    """Second differences of the torques in N m over a step of their own rows, (m, 3); 0 if
    held."""
    held: tuple[bool, ...]
    """Whether each torque is held until its next sample; the others are linear between samples."""
    load_known: bool
    """Whether C_load was measured; otherwise a constant is fitted to each stretch."""
    known_s: tuple[float, float]
    """First and last time in s at which all torques were measured."""
