# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Torques as affine functions of a speed, with an interval of what is left over: the load."""

from dataclasses import dataclass

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.dynamics.tube import Tube
from ddct_plant.models.load import resisting_torque
from ddct_plant.scenario.plant import holding_torque, make_load
from ddct_plant.scenario.settings import RunSettings

_POINTS = 33
"""Points at which the curve of the load is compared with its chord; between them it is bounded."""


@dataclass(frozen=True, eq=False)
class Law:
    """
    Torque of step k as offset_k + slope_k w + e_k with e_k in [low_k, high_k], (n,) each.

    The torque is in N m and w in rad/s: w_m for the engine, w_r for the load. Within the band of
    speeds every torque that the plant can give is of this form.
    """

    offset: np.ndarray
    slope: np.ndarray
    low: np.ndarray
    high: np.ndarray

    @property
    def middle(self) -> np.ndarray:
        """Middle of the interval in N m, (n,)."""
        return (self.low + self.high) / 2.0

    def rest(self, torque: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """Return e_k in N m, (n,), of torques in N m at speeds in rad/s."""
        return torque - self.offset - self.slope * speed


@np.errstate(over='ignore', invalid='ignore')
def load_law(settings: RunSettings, tube: Tube, start: int) -> Law:
    """
    Return the law of the torque at the wheel of a car that rolls forward.

    It is the road load over V_x = r_w w_r, and with a stick-slip clutch the friction of rolling
    and brake besides.
    """
    load = make_load(settings)
    steps = np.arange(start, start + len(tube.wheel_low))
    shares = np.linspace(0.0, 1.0, _POINTS)[:, np.newaxis]
    speeds = tube.wheel_low + shares * (tube.wheel_high - tube.wheel_low)
    force = load.forces(steps / 100.0)
    radius = load.wheel_radius
    torques = resisting_torque(load.drag, load.wind, force, radius, radius * speeds)
    if settings.stick_slip:
        holding = holding_torque(settings)
        torques = torques + np.array([holding.capacity(step / 100.0) for step in steps])
    # The curvature is at most 2 drag r^3, so between two points a chord is off by an eighth of it.
    gap = (speeds[-1] - speeds[0]) / (_POINTS - 1)
    return _chord(speeds, torques, 2.0 * load.drag * radius**3 * gap**2 / 8.0)


def load_of_run(settings: RunSettings, run: Trajectory, start: int) -> Law:
    """Return the law of the torque at the wheel near a run: its torque, and its tangent."""
    load = make_load(settings)
    torque, speed = run.load_torque[start:], run.wheel_speed[start:]
    if run.holding_torque is not None:
        torque = torque + run.holding_torque[start:]
    slope = 2.0 * load.drag * load.wheel_radius**2 * np.abs(load.wind + load.wheel_radius * speed)
    none = np.zeros(len(torque))
    return Law(torque - slope * speed, slope, none, none)


def _chord(speeds: np.ndarray, torques: np.ndarray, slack: np.ndarray) -> Law:
    """Return the law whose line goes through both ends of curves (points, n)."""
    width = speeds[-1] - speeds[0]
    slope = (torques[-1] - torques[0]) / np.where(width > 0.0, width, 1.0)
    offset = torques[0] - slope * speeds[0]
    rest = torques - offset - slope * speeds
    return Law(offset, slope, rest.min(axis=0) - slack, rest.max(axis=0) + slack)
