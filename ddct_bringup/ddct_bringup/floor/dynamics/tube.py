# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Speeds that a floor covers: a band around the motion of a rigid car that locks at an instant."""

from dataclasses import dataclass

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.dynamics.start import Start
from ddct_bringup.floor.dynamics.torque_cut import most_cut
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.engine_limits import LimitedEngine
from ddct_plant.scenario.plant import holding_torque, make_engine, make_load
from ddct_plant.scenario.settings import RunSettings

ENGINE_MARGIN = 12.0
"""Largest distance in rad/s of w_m below the speed of a rigid car, or above it after the lock."""
RACING = 100.0
"""Largest distance in rad/s of w_m above the rigid car with a linear slip, while plates slip."""
WHEEL_MARGIN = 1.5
"""Half-width in rad/s of the band of w_r, about 0.5 m/s of the car."""


@dataclass(frozen=True, eq=False)
class Tube:
    """Band of w_m and of w_r in rad/s at the steps from control start to the end, (n,) each."""

    engine_low: np.ndarray
    engine_high: np.ndarray
    wheel_low: np.ndarray
    wheel_high: np.ndarray

    def with_run(self, run: Trajectory, start: int) -> 'Tube':
        """Return the band widened so that it contains a run."""
        engine, wheel = run.engine_speed[start:], run.wheel_speed[start:]
        if self.contains(run, start):
            return self
        return Tube(
            np.minimum(self.engine_low, engine),
            np.maximum(self.engine_high, engine),
            np.minimum(self.wheel_low, wheel),
            np.maximum(self.wheel_high, wheel),
        )

    def contains(self, run: Trajectory, start: int) -> bool:
        """Return whether a run of the same length stays in the band."""
        engine, wheel = run.engine_speed[start:], run.wheel_speed[start:]
        return bool(
            np.all((self.engine_low <= engine) & (engine <= self.engine_high))
            and np.all((self.wheel_low <= wheel) & (wheel <= self.wheel_high))
        )


@np.errstate(over='ignore', invalid='ignore')
def rigid_tube(settings: RunSettings, start: Start, lock_time_s: float) -> Tube:
    """
    Return the band around a rigid car whose slip falls linearly to zero in `lock_time_s`.

    Any other slip moves w_m between the common speed of both plates and that of a free engine.
    J_m dw_m/dt + J_eq dw_p/dt = C_m - C_load/tau whatever the clutch does, and w_m - w_p is given.
    """
    p, scenario = settings.scenario.controlled_driveline, settings.scenario
    engine, load = make_engine(settings), make_load(settings)
    holding = holding_torque(settings) if settings.stick_slip else None
    limited = LimitedEngine(scenario.engine_limits) if scenario.engine_limits else None
    rest = p.shaft_inertia + p.gear.at_shaft(p.vehicle_inertia)
    steps, cut = scenario.steps - start.step + 1, most_cut(settings)
    slip = start.slip * np.maximum(1.0 - np.arange(steps) * PERIOD_S / max(lock_time_s, 1e-9), 0.0)
    momentum = p.engine_inertia * start.state[0] + rest * start.state[1]
    engines, shafts = np.empty(steps), np.empty(steps)
    for k in range(steps):
        shafts[k] = (momentum - p.engine_inertia * slip[k]) / (p.engine_inertia + rest)
        engines[k] = shafts[k] + slip[k]
        time_s = (start.step + k) * PERIOD_S
        torque = engine.demand(start.step + k) - (cut if slip[k] else 0.0)
        if limited:
            torque = limited.deliver(torque, engines[k])
        speed = p.gear.wheel_speed(shafts[k])
        resisting = load.torque(speed * scenario.vehicle.wheel_radius_m, time_s)
        resisting += holding.capacity(time_s) if holding else 0.0
        damping = p.engine_damping * engines[k] + p.shaft_damping * shafts[k]
        momentum += PERIOD_S * (torque - damping - p.gear.shaft_torque(resisting))
    wheels = p.gear.wheel_speed(shafts)
    rigid = (p.engine_inertia * engines + rest * shafts) / (p.engine_inertia + rest)
    above = np.where(slip != 0.0, RACING, ENGINE_MARGIN)
    return Tube(
        np.minimum(rigid, engines) - ENGINE_MARGIN,
        engines + above,
        wheels - WHEEL_MARGIN,
        wheels + WHEEL_MARGIN,
    )
