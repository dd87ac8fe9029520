# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Trajectories and facts made by hand: zeros and those of `thesis`, but for what a test gives."""

from typing import Any

import numpy as np

from ddct_bringup.bag.run_facts import RunFacts
from ddct_bringup.bag.trajectory import Trajectory

RAD_S_PER_RPM = np.pi / 30.0
CONTROL_START = 60
"""Step at which feedback starts in the runs of the tests."""


def made_run(slip_rpm: np.ndarray, **signals: object) -> Trajectory:
    """Return a run with this (N+1,) slip in rpm; signals in SI, by their names."""
    rows = len(slip_rpm)
    shapes = {'joint_speed': 4, 'joint_effort': 4, 'slip_reference': 1}
    arrays = {name: np.zeros((rows, width)) for name, width in shapes.items()}
    flat = ('vehicle_accel', 'torque_request', 'torque_demand', 'engine_torque')
    return Trajectory(
        {
            **arrays,
            **{name: np.zeros(rows) for name in flat},
            'slip_speed': np.asarray(slip_rpm, float) * RAD_S_PER_RPM,
            'status': ((),) * rows,
            **signals,
        }
    )


def times(duration_s: float = 3.0) -> np.ndarray:
    """Return the scenario times in s of a run."""
    return np.arange(round(100 * duration_s) + 1) / 100.0


def made_facts(**values: Any) -> RunFacts:
    """Return the facts of a run of `ls8` in `thesis`, but for these."""
    facts: dict[str, Any] = {
        'controller': 'ls8',
        'architecture': 'detailed',
        'scenario': 'thesis',
        'clutch': 'linear',
        'wear_gain': 1.0,
        'mode': 'lockstep',
        'seed': 0,
        'control_start_s': 0.6,
        'score_window_s': (0.6, 1.7),
        'duration_s': 3.0,
    }
    return RunFacts(**{**facts, **values})
