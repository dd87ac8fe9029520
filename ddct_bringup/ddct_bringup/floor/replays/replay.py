# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Requests of a program, replayed through the simulated plant."""

from typing import Any

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.case import Case
from ddct_controllers.loop import ObservedStep, PlantLoop, Request
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.scenario.settings import RunSettings

CLOSING_SHARE = 1.1
"""Request over C_fOL from the lock on."""
CLOSING_RAMP = 600.0
"""Rate in N m/s of the request then; with more the undershoot of G_a opens the clutch."""
FADE_S = 0.2
"""Time in s over which the torque that has taken the slip to zero fades out."""
CLOSED = 500.0
"""Highest of these requests in N m."""


def usual_requests(case: Case) -> np.ndarray:
    """
    Return requests in N m from control start to the end, (n,), that nearly lock a rigid car.

    These are C_fOL, and what takes the slip linearly to zero until the lock. Afterwards the
    request rises, so that the plates stay locked.
    """
    scenario = case.settings.scenario
    p = scenario.controlled_driveline
    static = StaticTorque(p, scenario.equilibrium)
    tube = case.tube
    wheel = (tube.wheel_low + tube.wheel_high) / 2.0
    engine = (tube.engine_low + tube.engine_high) / 2.0
    load = case.load.offset + case.load.slope * wheel + case.load.middle
    drive = case.engine.offset + case.engine.slope * engine + case.engine.middle
    speeds: Any = (drive, load, engine, p.gear.shaft_speed(wheel))
    torque: Any = static.torque(*speeds)
    rest = p.shaft_inertia + p.gear.at_shaft(p.vehicle_inertia)
    joint = p.engine_inertia * rest / (p.engine_inertia + rest)
    time_s = np.arange(len(torque)) * PERIOD_S
    lock_s = case.lock.time_s
    slipping = torque + joint * abs(case.start.slip) / max(lock_s, PERIOD_S)
    # A linear clutch has no lock, and C_fOL keeps its slip.
    if case.settings.stick_slip:
        fading = (slipping - torque) * np.clip(1.0 - (time_s - lock_s) / FADE_S, 0.0, 1.0)
        closing = CLOSING_SHARE * torque + fading + CLOSING_RAMP * (time_s - lock_s)
    else:
        closing = torque
    requests = np.where(time_s < lock_s, slipping, np.minimum(closing, CLOSED))
    middle = (case.capacity.low + case.capacity.high) / 2.0
    return np.asarray(np.maximum(requests - middle, 0.0) / case.settings.case.wear_gain)


def replayed(case: Case, requests: np.ndarray) -> Trajectory:
    """Return the run of the simulated plant with requests (n,) in N m, the usual ones after."""
    every, known = usual_requests(case), len(requests)
    every[:known] = requests
    if case.settings.stick_slip:
        after = np.arange(1, len(every) - known + 1)
        # A step would open the clutch first, as G_a undershoots.
        begun = every[known - 1] if known else every[0]
        every[known:] = np.minimum(every[known:], begun + CLOSING_RAMP * PERIOD_S * after)
    return run_requests(case.settings, np.concatenate([case.start.requests, every]))


class ReplayedLoop(PlantLoop):
    """The plant of a run that is asked for given torques; its handover is that of every run."""

    def __init__(self, settings: RunSettings, requests: np.ndarray) -> None:
        """Start in the run's initial state; the requests (n,) in N m are those of each step."""
        super().__init__(settings)
        self._requests = requests

    def request(self, observed: ObservedStep) -> Request:
        """Return the given request of the step."""
        return Request(float(self._requests[observed.observation.tick.step]), None, {})


def run_requests(settings: RunSettings, requests: np.ndarray) -> Trajectory:
    """Return the run of the simulated plant with the torque requests (n,) in N m of each step."""
    loop = ReplayedLoop(settings, requests)
    rows = [reply.signals for reply in loop.replies(settings.scenario.steps)]
    names = [name for name, first in rows[0].items() if first is not None]
    return Trajectory.of_columns({name: [row[name] for row in rows] for name in names})
