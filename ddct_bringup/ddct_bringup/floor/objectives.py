# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics that have a floor: each as a linear map of the signals, by the product's own filters."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from ddct_bringup.floor.dynamics.motion import Motion
from ddct_bringup.metrics.signals.mean_motion import jerk_means
from ddct_bringup.metrics.signals.vibration import jerk, strongest_stretch, weighted_acceleration
from ddct_bringup.verdict.limits import TRACTION
from ddct_plant.base.timebase import PERIOD_S, steps_in
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.scenario.scenario import Scenario

AXIS_FACTOR = 1.4
"""Factor of longitudinal vibration in a dose for health (2002/44/EC, Annex, part B, 1)."""


@dataclass(frozen=True, eq=False)
class Signals:
    """Signals of a run, or with one row for each variable, that metrics are computed from."""

    acceleration: np.ndarray
    """A_x in m/s^2, (..., N + 1)."""
    torsion_speed: np.ndarray
    """Torsion speed w_sr in rad/s, (..., N + 1)."""
    driving: np.ndarray
    """Driving force at the wheels over the mass of the car in m/s^2, (..., N + 1)."""
    slip_acceleration: np.ndarray | None
    """dw_d/dt in rad/s^2 just before the lock, (..., 1); None without a lock."""
    start: int
    """Step of control start."""
    window: tuple[int, int]
    """First and last step of the score window."""
    engagements_a_day: float

    @classmethod
    def of_motion(cls, motion: Motion, scenario: Scenario, engagements_a_day: float) -> 'Signals':
        """Return the signals with one row for each variable of a motion."""
        slope = motion.slip_acceleration
        return cls(
            np.ascontiguousarray(motion.acceleration.T),
            np.ascontiguousarray(motion.torsion_speed.T),
            np.ascontiguousarray(motion.driving.T),
            None if slope is None else slope[:, np.newaxis],
            motion.start,
            window_of(scenario),
            engagements_a_day,
        )

    @property
    def scored(self) -> slice:
        """Samples of the score window, both ends included."""
        return slice(self.window[0], self.window[1] + 1)


def window_of(scenario: Scenario) -> tuple[int, int]:
    """Return the first and the last step of the score window."""
    first, last = (steps_in('score_window_s', time) for time in scenario.score_window_s)
    return first, last


Rows = Callable[[Signals], np.ndarray | None]


@dataclass(frozen=True)
class Peak:
    """A metric that is the largest magnitude, or value, of a linear map of the signals."""

    unit: str
    of: Rows
    """Function that returns the mapped signals, (..., n); None where the metric is undefined."""
    one_sided: bool = False
    """Whether it is the largest value rather than the largest magnitude."""

    def value(self, signals: Signals) -> float | None:
        """Return the metric of a run."""
        mapped = self.of(signals)
        if mapped is None or not mapped.size:
            return None
        return float(np.max(mapped if self.one_sided else np.abs(mapped)))


@dataclass(frozen=True)
class RootMeanSquare:
    """A metric that is a function of root mean squares of linear maps of the signals."""

    unit: str
    of: Rows
    """Function that returns the mapped signals, (..., n)."""
    sliding: bool = False
    """Whether it is the largest over all stretches that are as long as the score window."""
    scale: Callable[[Signals], float] = lambda signals: 1.0
    """Factor from the root mean square to a lower bound of the metric."""
    trapezoid: bool = False
    """Whether the first and the last sample of a stretch count half."""
    exactly: Callable[[Signals], np.ndarray | float] | None = None
    """Function that computes the metric where it is more than one root mean square."""

    def value(self, signals: Signals) -> float | None:
        """Return the metric of a run."""
        mapped = self.of(signals)
        if mapped is None:
            return None
        if self.exactly:
            return float(self.exactly(signals))
        return self.scale(signals) * float(np.sqrt(np.mean(mapped**2)))

    def weights(self, signals: Signals) -> np.ndarray:
        """Return the weights of the squares in the mean over a stretch; their sum is 1."""
        weights = np.ones(signals.window[1] - signals.window[0] + 1)
        if self.trapezoid:
            weights[[0, -1]] = 0.5
        return weights / weights.sum()


Objective = Peak | RootMeanSquare


def _jerk(signals: Signals) -> np.ndarray:
    return jerk(signals.acceleration)[..., signals.start :]


def _acceleration(signals: Signals) -> np.ndarray:
    return signals.acceleration[..., signals.start :]


def _centred(values: np.ndarray, signals: Signals) -> np.ndarray | None:
    """Return the samples of the score window less their mean; None where the run ends before."""
    if values.shape[-1] <= signals.window[1]:
        return None
    window = values[..., signals.scored]
    return window - window.mean(axis=-1, keepdims=True)


def _weighted(signals: Signals) -> np.ndarray | None:
    if signals.acceleration.shape[-1] <= signals.window[1]:
        return None
    first = min(signals.window[0], signals.start)
    return weighted_acceleration(signals.acceleration)[..., first:]


def _strongest(signals: Signals) -> tuple[np.ndarray, np.ndarray]:
    mapped = _weighted(signals)
    assert mapped is not None
    return strongest_stretch(mapped, signals.window[1] - signals.window[0])


def _dose_scale(signals: Signals) -> float:
    """
    Return the factor from the r.m.s. over a stretch of n periods T to a bound of the daily dose.

    With weights w that are one half at the ends the integral of a^4 by trapezoids is T sum(w a^4),
    at least T (sum(w a^2))^2 / n (Cauchy-Schwarz), which is n T times the fourth power of the
    r.m.s. with these weights.
    """
    periods = signals.window[1] - signals.window[0]
    day = AXIS_FACTOR * signals.engagements_a_day**0.25
    return day * (periods * PERIOD_S) ** 0.25


OBJECTIVES: Mapping[str, Objective] = {
    'peak_jerk': Peak('m/s^3', _jerk),
    'peak_acceleration': Peak('m/s^2', _acceleration),
    TRACTION: Peak('m/s^2', lambda signals: signals.driving, one_sided=True),
    'mean_jerk': Peak('m/s^3', lambda signals: jerk_means(_acceleration(signals))),
    'acceleration_std_m_s2': RootMeanSquare(
        'm/s^2', lambda signals: _centred(signals.acceleration, signals)
    ),
    'torsion_speed_std_rpm': RootMeanSquare(
        'rpm', lambda signals: _centred(rpm_from_rad_s(signals.torsion_speed), signals)
    ),
    'slip_acceleration_at_lock': Peak('rad/s^2', lambda signals: signals.slip_acceleration),
    'weighted_acceleration': RootMeanSquare(
        'm/s^2', _weighted, sliding=True, exactly=lambda signals: _strongest(signals)[0]
    ),
    'daily_vibration_dose': RootMeanSquare(
        'm/s^1.75',
        _weighted,
        sliding=True,
        scale=_dose_scale,
        trapezoid=True,
        exactly=lambda signals: (
            AXIS_FACTOR * signals.engagements_a_day**0.25 * _strongest(signals)[1]
        ),
    ),
}
"""Metrics by name: that of the criterion where there is one, else that of the metric."""
