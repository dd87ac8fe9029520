# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Instants at which the plates of a stick-slip clutch lock, release or pass through zero slip."""

import math
from collections.abc import Iterator

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models import driveline
from ddct_plant.models.driveline import LOCK, PHASES, RELEASE, PhaseEvent

SLIPPING, LOCKED = PHASES.index(driveline.SLIPPING), PHASES.index(driveline.LOCKED)
"""Values of `clutch_phase`."""


def events_of(trajectory: Trajectory, kind: str, after: int = 0) -> Iterator[PhaseEvent]:
    """Yield the events of a kind after a step in order of time; none for a linear clutch."""
    periods = (trajectory.phase_events or ())[after + 1 :]
    return (event for events in periods for event in events if event.kind == kind)


def locked_at(trajectory: Trajectory, step: int) -> bool:
    """Return whether the plates are locked at a step; False for a linear clutch."""
    phase = trajectory.clutch_phase
    return phase is not None and len(phase) > step and phase[step] == LOCKED


def first_lock(trajectory: Trajectory, start: int) -> PhaseEvent | None:
    """Return the first lock after step `start`; None without one, or if locked at `start`."""
    if locked_at(trajectory, start):
        return None
    return next(events_of(trajectory, LOCK, after=start), None)


def first_zero_slip(trajectory: Trajectory, start: int) -> tuple[int, PhaseEvent] | None:
    """
    Return the first lock or reversal after step `start`, and the step that ends its period.

    None without one, and where the slip is zero at `start`.
    """
    if trajectory.steps < start or trajectory.slip_speed[start] == 0.0:
        return None
    return next(
        (
            (step, event)
            for step, events in enumerate(trajectory.phase_events or ())
            for event in events
            if step > start and event.kind != RELEASE
        ),
        None,
    )


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
