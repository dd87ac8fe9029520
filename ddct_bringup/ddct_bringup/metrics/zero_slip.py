# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Instants at which the plates of a stick-slip clutch lock, release or pass through zero slip."""

import math
from typing import Any, NamedTuple

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models import driveline
from ddct_plant.models.driveline import PHASES

SLIPPING, LOCKED = PHASES.index(driveline.SLIPPING), PHASES.index(driveline.LOCKED)
"""Values of `clutch_phase`."""


class Events(NamedTuple):
    """
    Events of the plates of a clutch in order of time: (E,) of one run, or (R, E) of R runs.

    E is that of the run with most of them, at least 1. Where a run has fewer, the others have the
    step -1, no kind, and values that are not numbers.
    """

    step: np.ndarray
    """Step that ends the period of the event."""
    time_s: np.ndarray
    """Exact scenario time in s."""
    kind: np.ndarray
    slip_acceleration: np.ndarray
    """Slope of w_d in rad/s^2 just before the event."""

    @classmethod
    def of(cls, periods: Any) -> 'Events':
        """Return those of the periods of one run, (N+1,), or of R runs, an array (R, N+1)."""
        several = isinstance(periods, np.ndarray) and periods.ndim == 2
        found = [
            [(step, *event) for step, events in enumerate(run) if events for event in events]
            for run in (periods.tolist() if several else [periods])
        ]
        most = max(1, *map(len, found))
        filled = [each + [_NO_EVENT] * (most - len(each)) for each in found]
        rows = filled if several else filled[0]
        columns: Any = np.moveaxis(np.array(rows, dtype=object), -1, 0)
        return cls(*map(np.ndarray.astype, columns, (int, float, str, float)))

    def after(self, step: int, kind: str) -> np.ndarray:
        """Return whether each event is of a kind and after a step, (..., E)."""
        return (self.kind == kind) & (self.step > step)

    def first(self, counted: np.ndarray) -> 'Events':
        """Return of each run the first event of those that are `counted`, (...) each."""
        place, found = np.argmax(counted, axis=-1), counted.any(axis=-1)
        of_each: Any = zip(self, _NO_EVENT, strict=True)
        return Events(*(np.where(found, _at(values, place), none) for values, none in of_each))


_NO_EVENT = -1, math.nan, '', math.nan
"""Step and values in place of an event that a run does not have."""


def locked_at(trajectory: Trajectory, step: int) -> np.ndarray:
    """Return whether the plates are locked at a step, (...); never for a linear clutch."""
    phase = trajectory.clutch_phase
    if phase is None or trajectory.steps < step:
        return np.zeros(trajectory.slip_speed.shape[:-1], dtype=bool)
    locked: np.ndarray = phase[..., step] == LOCKED
    return locked


def first_sign_change(slip: np.ndarray, start: int) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the time in s from step `start` to the first sign change, and the slope there, (...).

    `slip` is (..., N+1) in rad/s, its slope in rad/s^2; both are NaN without a sign change.
    """
    if start >= slip.shape[-1]:
        never = np.full(slip.shape[:-1], math.nan)
        return never, never
    changed = slip[..., start:] * np.sign(slip[..., start : start + 1]) <= 0.0
    after = start + np.argmax(changed, axis=-1)
    # Without a sign change argmax returns `start`, as it does where the slip is zero at `start`.
    found = after > start
    last, before = (_at(slip, np.maximum(after - back, 0)) for back in range(2))
    step = before - last
    with np.errstate(divide='ignore', invalid='ignore'):  # where there is none
        time = (after - 1 - start + before / step) * PERIOD_S
    return np.where(found, time, math.nan), np.where(found, -step / PERIOD_S, math.nan)


def _at(values: np.ndarray, index: np.ndarray) -> np.ndarray:
    return np.take_along_axis(values, index[..., np.newaxis], axis=-1)[..., 0]
