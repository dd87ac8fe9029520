# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Slip references of many shifts, each of which starts with the share 1 of its handover."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.batch.references import Points, make_descents
from ddct_plant.scenario.settings import KnownSettings


class ShiftReferences:
    """Slip references of R shifts of one kind, the counterpart of `DescendingReference`."""

    def __init__(self, runs: Sequence[KnownSettings], preview_steps: int, steps: int) -> None:
        """Compute everything that does not depend on the slip, up to step `steps`."""
        self._points = preview_steps + 1
        self._descents = make_descents(runs, preview_steps, steps)
        self._started = np.zeros(len(runs), dtype=bool)
        self._start = np.zeros(len(runs), dtype=int)
        self._start_value = np.zeros(len(runs))

    def update(self, step: int, slip_speed: np.ndarray, share: np.ndarray) -> Points:
        """
        Return references and rates at steps k, k + 1, ..., k + P, (R, P + 1), in rad/s, rad/s^2.

        For w_d in rad/s and the shares of C_fOL, (R,) each; below 1 a reference equals w_d.
        """
        self._start = np.where(self._started, self._start, step)
        self._start_value = np.where(self._started, self._start_value, slip_speed)
        self._started |= share == 1.0
        if not self._started.any():
            speeds = np.repeat(slip_speed[:, np.newaxis], self._points, axis=1)
            return speeds, np.zeros_like(speeds)
        speeds, rates = self._descents.at(self._start_value, step - self._start, self._points)
        if not self._started.all():
            waiting = ~self._started[:, np.newaxis]
            speeds = np.where(waiting, slip_speed[:, np.newaxis], speeds)
            rates = np.where(waiting, 0.0, rates)
        return speeds, rates
