# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Engine torque as an affine function of w_m, with an interval of what its limits leave over."""

from dataclasses import dataclass

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.dynamics.laws import Law
from ddct_bringup.floor.dynamics.torque_cut import cut_per_slip, demanded_torque, most_cut
from ddct_bringup.floor.dynamics.tube import Tube
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.engine_limits import EngineLimits
from ddct_plant.scenario.plant import make_engine
from ddct_plant.scenario.settings import RunSettings

_STEP = 1e-3
"""Change of w_m in rad/s over which the slope of the full-load curve is taken."""


@dataclass(frozen=True, eq=False)
class Integral:
    """Part of C_m that depends on speeds before: S_k+1 = keep_k S_k + gain_k w_k, S_0 = 0."""

    keep: np.ndarray
    gain: np.ndarray
    share: np.ndarray
    """Share of S_k in the torque of step k, (n,)."""

    def over(self, speed: np.ndarray) -> np.ndarray:
        """Return S_k for speeds w_k in rad/s, (n,)."""
        sums = np.zeros(len(speed))
        for k in range(len(speed) - 1):
            sums[k + 1] = self.keep[k] * sums[k] + self.gain[k] * speed[k]
        return sums


@dataclass(frozen=True, eq=False)
class EngineLaw(Law):
    """Law of C_m, with lines over w_m that the torque is below, or above, in each step."""

    lines: tuple[tuple[np.ndarray, np.ndarray, float], ...] = ()
    """Offset and slope of each line, (n,), and 1 where the torque is at most on it, -1 where it is
    at least; the slope is in N m s/rad."""
    integral: Integral | None = None
    """Part of the torque that depends on speeds before; None without one."""
    least_speed: np.ndarray | None = None
    """Least w_m in rad/s at which the engine gives this torque, (n,); None where any is enough."""
    cut_per_slip: float = 0.0
    """Largest torque cut in N m per rad/s of slip, 0 where it does not depend on the slip."""


def demand_law(
    settings: RunSettings, start: int, steps: int, locked: int | None = None
) -> EngineLaw:
    """
    Return the law of C_m of runs in which the engine delivers the demand throughout.

    A handover may take a torque cut off it, which fades as the slip goes to zero, and is zero from
    step `locked` after `start` on. With sensors it depends on what they measure.
    """
    engine, none = make_engine(settings), np.zeros(steps)
    demand = np.array([engine.demand(start + k) for k in range(steps)])
    limits, most = settings.scenario.engine_limits, most_cut(settings)
    least = None if limits is None else _least_speed(limits, demand, most)
    cut, per_slip = np.full(steps, most), cut_per_slip(settings)
    if per_slip:
        cut[locked:] = 0.0
    return EngineLaw(demand, none, -cut, none, least_speed=least, cut_per_slip=per_slip)


def _least_speed(limits: EngineLimits, demand: np.ndarray, cut: float) -> np.ndarray:
    """
    Return a lower bound of w_m in rad/s for an engine that delivers demands in N m, (n,).

    Below it full load is less, or idle control asks for more, whose integral is not negative. At
    most `cut` in N m is taken off a demand.
    """
    reduced = np.maximum(demand - cut, 0.0)
    speeds, torques = limits.speed_rad_s, limits.full_load_n_m
    least = np.full(len(demand), limits.over_rev_rad_s)
    for i in reversed(range(len(speeds) - 1)):
        rise = torques[i + 1] - torques[i]
        share = np.clip((reduced - torques[i]) / rise, 0.0, 1.0) if rise > 0.0 else 0.0
        reached = reduced <= max(torques[i], torques[i + 1])
        least = np.where(reached, speeds[i] + share * (speeds[i + 1] - speeds[i]), least)
    if limits.idle_gain_n_m_s > 0.0:
        idles = np.maximum(least, limits.idle_rad_s - demand / limits.idle_gain_n_m_s)
        least = np.where(demand < limits.idle_most_n_m, idles, least)
    return least


def law_of_run(settings: RunSettings, run: Trajectory, start: int) -> EngineLaw:
    """
    Return the law of C_m near a run: its torque, and what it changes by with w_m.

    Idle control integrates the speed, so that its torque depends on the speeds before too.
    """
    limits = settings.scenario.engine_limits
    torque, speed = run.engine_torque[start:], run.engine_speed[start:]
    slope, none = np.zeros(len(torque)), np.zeros(len(torque))
    if limits is None:
        return EngineLaw(torque, slope, none, none)
    full = _full(limits, speed)
    acts = torque != demanded_torque(run)[start:]
    on_full_load = acts & np.isclose(torque, full, rtol=1e-9)
    rise = _full(limits, speed + _STEP) - full
    slope[on_full_load] = rise[on_full_load] / _STEP
    idles = acts & ~on_full_load & (torque < limits.idle_most_n_m)
    slope[idles] = -limits.idle_gain_n_m_s
    free = _unlimited_integral(limits, run.engine_speed)[start:]
    integral = Integral(
        keep=free.astype(float),
        gain=-limits.idle_integral_n_m * PERIOD_S * free,
        share=idles.astype(float),
    )
    offset = torque - slope * speed - integral.share * integral.over(speed)
    return EngineLaw(offset, slope, none, none, integral=integral)


def _unlimited_integral(limits: EngineLimits, speed: np.ndarray) -> np.ndarray:
    """Return at which steps the integral of idle control stays within its limits, (n,)."""
    integral, free = 0.0, np.zeros(len(speed), dtype=bool)
    for k, missing in enumerate((limits.idle_rad_s - speed).tolist()):
        integral += limits.idle_integral_n_m * missing * PERIOD_S
        free[k] = 0.0 < integral < limits.idle_most_n_m
        integral = min(max(integral, 0.0), limits.idle_most_n_m)
    return free


def engine_law(settings: RunSettings, tube: Tube, start: int, idle_integral: float) -> EngineLaw:
    """
    Return the law of C_m; the demand itself where the limits of the engine cannot act.

    `idle_integral` is the most in N m that the integral of idle control can be at control start;
    it grows at most as in the slowest run of the band. The engine stays below its cut.
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
    fastest = np.maximum(np.minimum(tube.engine_high, limits.cut_rad_s), slowest + 1.0)
    ends = [slowest, fastest]
    inner = [np.clip(speed, *ends) for speed in limits.speed_rad_s]
    full = np.array([_full(limits, speed) for speed in (*ends, *inner)])
    high = np.maximum(law.offset, _idle(limits, slowest, integral))
    low = np.minimum(law.offset, full.min(axis=0))
    free = (high > law.offset) | (low < law.offset)
    if not free.any():
        return law
    cut = most_cut(settings)
    below, slope, side = _chord_below(limits, law, ends)
    return EngineLaw(
        law.offset,
        law.slope,
        low - cut - law.offset,
        high - law.offset,
        (*_full_load_lines(limits, slowest, fastest), (below - cut, slope, side)),
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
