# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Stability and margins of a unit-feedback loop, continuous or sampled, both exact.

The margins are ours: python-control finds those of a sampled loop by polynomials, and is wrong.
"""

import math
from dataclasses import astuple, dataclass

import numpy as np

from ddct_controllers.design.analysis.loop_curve import LoopCurve, complementary, sensitivity
from ddct_controllers.design.analysis.loops import ContinuousLoop
from ddct_controllers.design.state_space import close_loop
from ddct_plant.linear.lti import StateSpace


@dataclass(frozen=True)
class LoopMargins:
    """
    Margins of a stable closed loop to instability, with crossover and bandwidth.

    `LOOP_QUANTITIES` defines the quantities. Each is None when the closed loop is unstable, and
    infinite where nothing limits it.
    """

    stable: bool
    """Whether the closed loop is stable, by its poles."""
    gain_margin_db: float | None = None
    gain_reduction_margin_db: float | None = None
    """Least decrease in dB of the loop gain that makes it unstable, as a positive number."""
    phase_margin_deg: float | None = None
    delay_margin_s: float | None = None
    disk_margin: float | None = None
    """Disk margin alpha; gains from (2 - alpha)/(2 + alpha) to its inverse are safe."""
    sensitivity_peak: float | None = None
    complementary_peak: float | None = None
    crossover_rad_s: float | None = None
    """Crossover frequency in rad/s; 0 when |L| is below 1 everywhere."""
    bandwidth_rad_s: float | None = None
    """Bandwidth in rad/s; 0 when |T| is below 1/sqrt(2) at rest."""

    def limited(self) -> 'LoopMargins':
        """Return them as JSON can have them, which has no infinity: None where nothing limits."""
        stable, *margins = astuple(self)
        return LoopMargins(stable, *(None if each == math.inf else each for each in margins))


def loop_margins(loop: ContinuousLoop | StateSpace) -> LoopMargins:
    """
    Return the margins of L closed by unit negative feedback.

    Crossings and peaks are bracketed on a grid, dense around every pole, and then solved for. The
    delay margin of a sampled loop counts a delay tau as exp(-j omega tau), which is exact for
    whole samples.
    """
    if not closed_loop_stable(loop):
        return LoopMargins(stable=False)
    curve = LoopCurve(loop)
    crossovers = curve.crossings(lambda values: np.log(np.abs(values)))
    lags = [float(np.angle(-curve.at(omega))) for omega in crossovers]
    gains = curve.critical_gains()
    (disk, _), (of_s, _), (of_t, _) = curve.peaks(_of_disk, sensitivity, complementary)
    return LoopMargins(
        stable=True,
        gain_margin_db=_decibel(min((gain for gain in gains if gain > 1.0), default=math.inf)),
        gain_reduction_margin_db=-_decibel(max((g for g in gains if g < 1.0), default=0.0)),
        phase_margin_deg=math.degrees(min(map(abs, lags), default=math.inf)),
        delay_margin_s=min(
            (lag % math.tau / omega for lag, omega in zip(lags, crossovers, strict=True)),
            default=math.inf,
        ),
        disk_margin=2.0 / disk,
        sensitivity_peak=of_s,
        complementary_peak=of_t,
        crossover_rad_s=max(crossovers, default=0.0),
        bandwidth_rad_s=_bandwidth_rad_s(curve),
    )


def _of_disk(values: np.ndarray) -> np.ndarray:
    """Return |S - T| of values of L, elementwise."""
    return np.abs((1.0 - values) / (1.0 + values))


def _bandwidth_rad_s(curve: LoopCurve) -> float:
    level = math.sqrt(0.5)
    if complementary(curve.values[:1])[0] < level:
        return 0.0
    falls = curve.crossings(lambda values: complementary(values) - level)
    return min(falls, default=math.inf)


def _decibel(gain: float) -> float:
    return 20.0 * math.log10(gain) if gain > 0.0 else -math.inf


def closed_loop_stable(loop: ContinuousLoop | StateSpace) -> bool:
    """Return whether L closed by unit negative feedback has no pole on or beyond the boundary."""
    return unstable_poles(loop) == 0


def unstable_poles(loop: ContinuousLoop | StateSpace) -> int:
    """
    Return the number of closed-loop poles on or beyond the stability boundary.

    With a dead time tau there are infinitely many poles, and all but a few are stable. Growing
    from 0, tau takes two across at w when L(jw) exp(-jw tau) = -1: outwards where |L| falls with
    frequency, inwards where it rises (Walton and Marshall's direct method). L is strictly proper.
    """
    if not isinstance(loop, ContinuousLoop):
        return _unstable(loop)
    without_delay = ContinuousLoop(loop.transfer_function)
    count = _unstable(without_delay.to_state_space())
    if not loop.delay_s:
        return count
    curve = LoopCurve(without_delay)
    for omega in curve.crossings(lambda values: np.log(np.abs(values))):
        first_s = np.angle(-curve.at(omega)) % math.tau / omega
        times = math.floor((loop.delay_s - first_s) * omega / math.tau) + 1
        falling = abs(curve.at(omega * (1.0 - 1e-6))) > 1.0
        count += 2 * max(times, 0) * (1 if falling else -1)
    return count


def _unstable(loop: StateSpace) -> int:
    poles = np.linalg.eigvals(close_loop(loop).a)
    beyond = poles.real >= 0.0 if loop.period_s is None else np.abs(poles) >= 1.0
    return int(np.count_nonzero(beyond))
