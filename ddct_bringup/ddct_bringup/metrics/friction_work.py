# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Friction work of an engagement relative to the minimum for a rigid car."""

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.metrics.signals.integrals import integral
from ddct_plant.base.units import rad_s_from_rpm

LEAST_SLIP_RPM = 50.0
"""Least slip at control start, in rpm; below it the minimum is too small for a useful ratio."""


def slips_at(trajectory: Trajectory, start: int) -> np.ndarray:
    """Return whether the plates slip at step `start`, (...)."""
    slip = trajectory.slip_speed[..., start : start + 1]
    return np.any(np.abs(slip) >= rad_s_from_rpm(LEAST_SLIP_RPM), axis=-1)


def work_over_least(
    trajectory: Trajectory, start: int, plant: JudgedPlant | None
) -> np.ndarray | None:
    """
    Return the friction work from step `start` on over J_m J_eq/(J_m + J_eq) w_d^2/2, (...).

    The denominator is the energy that two free rigid inertias lose when the slip w_d goes to zero;
    the work is larger when the engine drives meanwhile. Not finite below 50 rpm of slip at
    `start`; None where the plant is unknown or the run ends before `start`.
    """
    if plant is None or trajectory.steps < start:
        return None
    least = plant.joint_inertia * trajectory.slip_speed[..., start] ** 2 / 2.0
    slips = slips_at(trajectory, start)
    return np.where(slips, friction_work(trajectory, start), np.nan) / np.where(slips, least, 1.0)


def work_of_both(trajectory: Trajectory, start: int) -> np.ndarray:
    """Return the friction work in J of all clutches of a run from step `start` on, (...)."""
    own = friction_work(trajectory, start)
    if not trajectory.shift:
        return own
    return own + np.sum(trajectory.off_going_friction_work[..., start + 1 :], axis=-1)


def friction_work(trajectory: Trajectory, start: int = 0) -> np.ndarray:
    """
    Return the friction work in J from step `start` on, (...): exact where the run records it.

    Without a record it is the integral of |C_f w_d| by trapezoids.
    """
    if trajectory.friction_work is not None:
        # The work recorded at a step is that of the period before; at step 0 it is zero.
        return np.sum(trajectory.friction_work[..., start + 1 if start else 0 :], axis=-1)
    torque = trajectory.primary_shaft_effort[..., start:]
    return integral(np.abs(torque * trajectory.slip_speed[..., start:]))
