# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Torque cut of a gear shift: what a handover may take off the driver's demand."""

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_controllers.handover.interface import CUT_FADE_RAD_S
from ddct_plant.scenario.settings import RunSettings

_RESIDUAL = 1e-9
"""Difference of two torques in N m that is rounding."""


def most_cut(settings: RunSettings) -> float:
    """Return the largest torque in N m that a handover takes off the demand, 0 without a shift."""
    shift = settings.scenario.shift
    return shift.torque_cut_n_m if shift else 0.0


def cut_per_slip(settings: RunSettings) -> float:
    """
    Return the largest cut in N m per rad/s of slip, 0 where the slip does not limit it.

    With sensors the cut depends on the measured slip.
    """
    return 0.0 if settings.known.sensed else most_cut(settings) / CUT_FADE_RAD_S


def demanded_torque(run: Trajectory) -> np.ndarray:
    """Return the demand that the engine of a run gets in N m, (N + 1,), less a torque cut."""
    demand: np.ndarray = run.torque_demand
    return demand if run.torque_cut is None else demand - run.torque_cut


def gives_demand(run: Trajectory, start: int) -> bool:
    """Return whether the engine delivers what it is demanded from step `start` on."""
    missing = np.abs(run.engine_torque - demanded_torque(run))[start:-1]
    # The engine subtracts a cut from the demand in an order of its own.
    rounding = 0.0 if run.torque_cut is None else _RESIDUAL
    return bool(missing.max(initial=0.0) <= rounding)


def cuts_as_usual(settings: RunSettings, run: Trajectory) -> bool:
    """Return whether a torque cut is at most that of the scenario, and fades with the slip."""
    most = np.full(len(run.torque_cut), most_cut(settings))
    if not settings.known.sensed:
        most = np.minimum(most, cut_per_slip(settings) * np.maximum(run.slip_speed, 0.0))
    return bool(np.all((run.torque_cut >= 0.0) & (run.torque_cut <= most + _RESIDUAL)))
