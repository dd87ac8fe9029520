# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The record of many runs, of the signals from which they are judged."""

from collections.abc import Mapping
from itertools import accumulate
from typing import Any

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.signals.topics import all_signals

_SIGNALS = (
    *('joint_speed', 'joint_effort', 'slip_speed', 'vehicle_accel'),
    *('load_torque', 'slip_reference', 'torque_request', 'torque_demand', 'engine_torque'),
)
"""Recorded signals; of a preview the first value is."""


class Recorder:
    """Record of R runs, step by step."""

    def __init__(self, steps: int, runs: int) -> None:
        """Make place for steps 0 to N."""
        sizes = {signal.name: signal.size or 1 for signal in all_signals()}
        ends = list(accumulate((sizes[name] for name in _SIGNALS), initial=0))
        self._rows = {name: slice(*ends[at : at + 2]) for at, name in enumerate(_SIGNALS)}
        self._record = np.empty((steps + 1, ends[-1], runs))

    def record(self, step: int, signals: Mapping[str, Any]) -> None:
        """Record the signals of a step, (R,) or a sequence of such for a signal of several."""
        for name, rows in self._rows.items():
            self._record[step, rows] = signals[name]

    def trajectory(self) -> Trajectory:
        """Return the stack of the runs, (R, N+1) for each signal."""
        # The samples of each run are contiguous, so metrics are summed in the order of one run.
        steps, rows, runs = self._record.shape
        values = np.empty((rows, runs, steps))
        for row in range(rows):
            values[row] = self._record[:, row].T
        single = {signal.name for signal in all_signals() if signal.size == 1}
        return Trajectory(
            {
                name: values[place.start] if name in single else np.moveaxis(values[place], 0, -1)
                for name, place in self._rows.items()
            }
        )
