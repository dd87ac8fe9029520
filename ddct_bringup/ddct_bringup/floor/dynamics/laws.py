# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Engine and load torque as affine functions of a speed, with an interval of the remainder."""

from dataclasses import dataclass

import numpy as np

from ddct_bringup.floor.dynamics.tube import Tube
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.engine_limits import EngineLimits
from ddct_plant.models.load import resisting_torque
from ddct_plant.scenario.plant import holding_torque, make_engine, make_load
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


@dataclass(frozen=True, eq=False)
class EngineLaw(Law):
    """Law of C_m, with lines over w_m that the torque is below, or above, in each step."""

    lines: tuple[tuple[np.ndarray, np.ndarray, float], ...] = ()
    """Offset and slope of each line, (n,), and 1 where the torque is at most on it, -1 where it is
    at least; the slope is in N m s/rad."""


def demand_law(settings: RunSettings, start: int, steps: int) -> EngineLaw:
    """Return the law of C_m of runs in which the engine delivers the demand throughout."""
    engine, none = make_engine(settings), np.zeros(steps)
    demand = np.array([engine.demand(start + k) for k in range(steps)])
    return EngineLaw(demand, none, none, none)


def engine_law(settings: RunSettings, tube: Tube, start: int, idle_integral: float) -> EngineLaw:
    """
    Return the law of C_m; the demand itself where the limits of the engine cannot act.

    `idle_integral` is the most in N m that the integral of idle control can be at control start;
    it grows at most as in the slowest run of the band. A run in which the rev limiter cuts the
    fuel is not covered.
    """
    limits, steps = settings.scenario.engine_limits, len(tube.engine_low)
    law = demand_law(settings, start, steps)
    if limits is None:
        return law
    # An engine at its stall speed ends the run, without a lock.
    slowest = np.maximum(tube.engine_low, limits.stall_rad_s)
    below = np.maximum(limits.idle_rad_s - slowest, 0.0)
    grown = idle_integral + limits.idle_integral_n_m * PERIOD_S * np.cumsum(below)
    integral = np.minimum(grown, limits.idle_most_n_m)
    fastest = np.maximum(np.minimum(tube.engine_high, limits.resume_rad_s), slowest + 1.0)
    ends = [slowest, fastest]
    inner = [np.clip(speed, *ends) for speed in limits.speed_rad_s]
    full = np.array([_full(limits, speed) for speed in (*ends, *inner)])
    high = np.maximum(law.offset, _idle(limits, slowest, integral))
    low = np.minimum(law.offset, full.min(axis=0))
    free = (high > law.offset) | (low < law.offset)
    if not free.any():
        return law
    return EngineLaw(
        law.offset,
        law.slope,
        low - law.offset,
        high - law.offset,
        (*_full_load_lines(limits, slowest, fastest), _chord_below(limits, law, ends)),
    )


def _full(limits: EngineLimits, speed: np.ndarray) -> np.ndarray:
    """Return the full-load torque in N m at speeds in rad/s."""
    return np.interp(speed, limits.speed_rad_s, limits.full_load_n_m)


def _idle(limits: EngineLimits, speed: np.ndarray, integral: np.ndarray) -> np.ndarray:
    """Return the torque of idle control in N m at speeds in rad/s."""
    proportional = limits.idle_gain_n_m_s * (limits.idle_rad_s - speed)
    return np.minimum(proportional + integral, limits.idle_most_n_m)


def _full_load_lines(
    limits: EngineLimits, low: np.ndarray, high: np.ndarray
) -> list[tuple[np.ndarray, np.ndarray, float]]:
    """Return the lines through the pieces of the full-load curve, raised above the curve."""
    speeds, torques = np.array(limits.speed_rad_s), np.array(limits.full_load_n_m)
    lines = []
    for i in range(len(speeds) - 1):
        if speeds[i] >= high.max() or speeds[i + 1] <= low.min():
            continue
        slope = (torques[i + 1] - torques[i]) / (speeds[i + 1] - speeds[i])
        offset = np.max(torques - slope * speeds)
        lines.append((np.full(len(low), offset), np.full(len(low), slope), 1.0))
    return lines


def _chord_below(
    limits: EngineLimits, law: Law, ends: list[np.ndarray]
) -> tuple[np.ndarray, np.ndarray, float]:
    """
    Return the line below min(demand, full load) over each band of speeds.

    It goes through both ends, lowered where the curve between them is below.
    """
    values = [np.minimum(law.offset, _full(limits, speed)) for speed in ends]
    slope = (values[1] - values[0]) / (ends[1] - ends[0])
    offset = values[0] - slope * ends[0]
    for speed in limits.speed_rad_s:
        inner = np.clip(speed, *ends)
        curve = np.minimum(law.offset, _full(limits, inner))
        offset = np.minimum(offset, curve - slope * inner)
    return offset, slope, -1.0


def _chord(speeds: np.ndarray, torques: np.ndarray, slack: np.ndarray) -> Law:
    """Return the law whose line goes through both ends of curves (points, n)."""
    width = speeds[-1] - speeds[0]
    slope = (torques[-1] - torques[0]) / np.where(width > 0.0, width, 1.0)
    offset = torques[0] - slope * speeds[0]
    rest = torques - offset - slope * speeds
    return Law(offset, slope, rest.min(axis=0) - slack, rest.max(axis=0) + slack)
