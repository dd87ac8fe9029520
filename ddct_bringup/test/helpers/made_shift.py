# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Gear shifts made by hand: from 16 to 9 times the wheel speed, but for what a test gives."""

from typing import Any

import numpy as np
from made_run import made_run

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.engagement import Engagement
from ddct_plant.models.driveline import PHASES, PhaseEvent

RATIOS = 16.0, 9.0
"""Total ratios of the off-going and the on-coming gear."""
START, SHARE_ONE, LOCK = 30, 50, 90
"""Steps of the start of the shift, of the first share of 1, and of the lock."""
STEPS = 150
WINDOW = (30, 140)
OPEN, SLIPPING, LOCKED = (float(PHASES.index(name)) for name in ('open', 'slipping', 'locked'))
STEP = np.arange(STEPS + 1)


def joints(first: Any = 0.0, second: Any = 0.0, third: Any = 0.0, fourth: Any = 0.0) -> np.ndarray:
    """Return the values of engine, on-coming shaft, wheel and driveshaft, (N+1, 4)."""
    return np.stack(
        [np.broadcast_to(each, STEP.shape) for each in (first, second, third, fourth)], 1
    )


def events(*each: tuple[float, str]) -> tuple[tuple[PhaseEvent, ...], ...]:
    """Return the events at these times in s, of these kinds, by step."""
    periods: list[tuple[PhaseEvent, ...]] = [()] * (STEPS + 1)
    for time_s, kind in each:
        step = int(np.ceil(100.0 * time_s - 1e-9))
        periods[step] = (*periods[step], PhaseEvent(time_s, kind, 0.0))
    return tuple(periods)


def made_shift(**signals: Any) -> Trajectory:
    """
    Return a shift at 10 rad/s of the wheels that locks at 0.9 s.

    The torque goes from 100 N m of the off-going clutch to 120 N m of the on-coming one in 0.2 s,
    and the wheel torque from 1500 to 1000 N m.
    """
    first, second = (10.0 * ratio for ratio in RATIOS)
    share = np.clip((STEP - START) / (SHARE_ONE - START), 0.0, 1.0)
    after = np.clip((STEP - SHARE_ONE) / (LOCK - SHARE_ONE), 0.0, 1.0)
    engine = first + (second - first) * after
    slip = engine - second
    made = {
        'joint_speed': joints(engine, second, 10.0),
        'joint_effort': joints(100.0, 120.0 * share, 0.0, 1500.0 - 500.0 * share),
        'clutch_phase': np.where(STEP < START, OPEN, np.where(STEP < LOCK, SLIPPING, LOCKED)),
        'phase_events': events((0.01 * LOCK, 'lock')),
        'friction_work': np.zeros(STEPS + 1),
        'clutch_temperature': np.full(STEPS + 1, 20.0),
        'handover_share': share,
        'torque_cut': np.zeros(STEPS + 1),
        'off_going_shaft_speed': np.full(STEPS + 1, first),
        'off_going_transmitted_torque': 100.0 * (1.0 - share),
        'off_going_slip_speed': engine - first,
        'off_going_clutch_phase': np.where(STEP < SHARE_ONE, LOCKED, OPEN),
        'off_going_friction_work': np.zeros(STEPS + 1),
        'tie_up_work': np.zeros(STEPS + 1),
        'off_going_phase_events': events((0.01 * SHARE_ONE, 'release')),
        'off_going_clutch_temperature': np.full(STEPS + 1, 20.0),
    }
    return made_run(slip * 30.0 / np.pi, **{**made, **signals})


def engagement_of(run: Trajectory) -> Engagement:
    """Return what the metrics of a shift are computed from."""
    return Engagement(run, START, WINDOW)
