# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The record of many runs, of the signals from which they are judged."""

from collections.abc import Mapping
from itertools import accumulate
from typing import Any

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.models.driveline import PhaseEvent
from ddct_plant.signals.topics import all_signals

_SIGNALS = (
    *('joint_speed', 'joint_effort', 'slip_speed', 'vehicle_accel'),
    *('load_torque', 'slip_reference', 'torque_request', 'torque_demand', 'engine_torque'),
)
_OF_STICKING = ('clutch_phase', 'friction_work', 'clutch_temperature')
"""Recorded signals, and those of plates that stick; of a preview the first value is."""


class Recorder:
    """Record of R runs, step by step."""

    def __init__(self, steps: int, runs: int, *, sticking: bool) -> None:
        """Make place for steps 0 to N."""
        names = _SIGNALS + _OF_STICKING if sticking else _SIGNALS
        sizes = {signal.name: signal.size or 1 for signal in all_signals()}
        ends = list(accumulate((sizes[name] for name in names), initial=0))
        self._rows = {name: slice(*ends[at : at + 2]) for at, name in enumerate(names)}
        self._record = np.empty((steps + 1, ends[-1], runs))
        self._events = np.empty((runs, steps + 1), dtype=object) if sticking else None
        if self._events is not None:
            self._events.fill(())

    def record(
        self,
        step: int,
        signals: Mapping[str, Any],
        events: Mapping[int, tuple[PhaseEvent, ...]],
    ) -> None:
        """
        Record the signals of a step, (R,) or a sequence of such for a signal of several.

        `events` are those of the clutches in the period before, by the index of their run.
        """
        for name, rows in self._rows.items():
            self._record[step, rows] = signals[name]
        if self._events is not None:
            for run, found in events.items():
                self._events[run, step] = found

    def trajectory(self) -> Trajectory:
        """Return the stack of the runs, (R, N+1) for each signal; events are objects there."""
        single = {signal.name for signal in all_signals() if signal.size == 1}
        signals: dict[str, Any] = {}
        # The samples of each run are contiguous, so metrics are summed in the order of one run.
        for name, place in self._rows.items():
            by_run = self._record[:, place].transpose(2, 0, 1)
            signals[name] = np.ascontiguousarray(by_run[..., 0] if name in single else by_run)
        if self._events is not None:
            signals['phase_events'] = self._events
        return Trajectory(signals)
