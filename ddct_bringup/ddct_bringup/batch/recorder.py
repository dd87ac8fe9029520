# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The record of many runs, of the signals from which they are judged."""

from collections.abc import Mapping
from itertools import accumulate
from typing import Any

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.batch.plant.friction_drivelines import RunEvents
from ddct_plant.signals.topics import all_signals

_SIGNALS = (
    *('joint_speed', 'joint_effort', 'slip_speed', 'vehicle_accel'),
    *('load_torque', 'slip_reference', 'torque_request', 'torque_demand', 'engine_torque'),
)
_OF_STICKING = ('clutch_phase', 'friction_work', 'clutch_temperature')
_OF_SHIFT = (
    *('handover_share', 'torque_cut', 'tie_up_work', 'off_going_shaft_speed'),
    *('off_going_slip_speed', 'off_going_clutch_phase', 'off_going_friction_work'),
    'off_going_clutch_temperature',
)
"""Recorded signals, those of plates that stick, those of a shift; of a preview the first."""


class Recorder:
    """Record of R runs, step by step."""

    def __init__(self, steps: int, runs: int, *, sticking: bool, shift: bool) -> None:
        """Make place for steps 0 to N."""
        names = [*_SIGNALS, *(_OF_STICKING if sticking else ()), *(_OF_SHIFT if shift else ())]
        events = ['phase_events'] if sticking else []
        if shift:
            events.append('off_going_phase_events')
        sizes = {signal.name: signal.size or 1 for signal in all_signals()}
        ends = list(accumulate((sizes[name] for name in names), initial=0))
        self._rows = {name: slice(*ends[at : at + 2]) for at, name in enumerate(names)}
        self._record = np.empty((steps + 1, ends[-1], runs))
        self._events = {name: np.empty((runs, steps + 1), dtype=object) for name in events}
        for of_clutch in self._events.values():
            of_clutch.fill(())

    def record(
        self,
        step: int,
        signals: Mapping[str, Any],
        events: Mapping[str, RunEvents],
    ) -> None:
        """
        Record the signals of a step, (R,) or a sequence of such for a signal of several.

        `events` are those in the period before, by the name of their signal.
        """
        for name, rows in self._rows.items():
            self._record[step, rows] = signals[name]
        for name, of_clutch in self._events.items():
            for run, found in events[name].items():
                of_clutch[run, step] = found

    def trajectory(self) -> Trajectory:
        """Return the stack of the runs, (R, N+1) for each signal; events are objects there."""
        single = {signal.name for signal in all_signals() if signal.size == 1}
        signals: dict[str, Any] = {**self._events}
        # The samples of each run are contiguous, so metrics are summed in the order of one run.
        for name, place in self._rows.items():
            by_run = self._record[:, place].transpose(2, 0, 1)
            signals[name] = np.ascontiguousarray(by_run[..., 0] if name in single else by_run)
        return Trajectory(signals)
