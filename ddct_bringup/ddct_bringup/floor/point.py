# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A run as a point of the program that bounds it."""

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.case import Case
from ddct_bringup.floor.dynamics.off_going import effects_of_run
from ddct_bringup.floor.dynamics.shapes import shape_effects
from ddct_plant.scenario.rules.shift import gears_of


def point_of(case: Case, run: Trajectory) -> np.ndarray:
    """Return a run as values of the variables, (columns,), the constant 1 first."""
    columns, first = case.motion.columns, case.start.step
    point = np.zeros(columns.count)
    point[0] = 1.0
    used = slice(first, first + columns.requests)
    point[1 : 1 + columns.requests] = np.maximum(run.torque_request[used], 0.0)
    resisting = run.load_torque[first:]
    if run.holding_torque is not None:
        resisting = resisting + run.holding_torque[first:]
    engine, wheel = run.engine_speed[first:], run.wheel_speed[first:]
    if columns.load.stop > columns.load.start:
        point[columns.load] = case.load.rest(resisting, wheel)[:-1]
    if columns.engine.stop > columns.engine.start:
        point[columns.engine] = case.engine.rest(run.engine_torque[first:], engine)[:-1]
    if run.clutch_phase is not None:
        _add_capacity(case, point, run)
    if case.start.off_going and len(case.start.off_going.most):
        gears, off_going = gears_of(case.settings.scenario), case.start.off_going
        periods = range(first + off_going.known, first + off_going.periods)
        effects = effects_of_run(case.settings, run, periods)
        point[columns.off_going] = np.linalg.solve(shape_effects(gears), effects.T).T.ravel()
    return point


def _add_capacity(case: Case, point: np.ndarray, run: Trajectory) -> None:
    """Write what the capacity of a run leaves over into its point."""
    columns, first = case.motion.columns, case.start.step
    rest = run.clutch_torque - case.settings.case.wear_gain * run.actuator_torque
    rest = rest[first : first + len(case.motion.capacity)]
    common = np.clip(rest[:, 0], case.capacity.low, case.capacity.high)
    if columns.capacity.stop > columns.capacity.start:
        point[columns.capacity] = common
    for k in columns.clipped:
        if k < len(rest):
            point[columns.of_nodes(k)] = rest[k] - common[k]
