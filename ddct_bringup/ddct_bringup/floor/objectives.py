# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics that have a floor: each as a linear map of the signals, by the product's own filters."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from ddct_bringup.floor.dynamics.motion import Motion
from ddct_bringup.metrics.signals.vibration import jerk, strongest_stretch, weighted_acceleration
from ddct_plant.base.timebase import STEPS_PER_S, steps_in
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.scenario.scenario import Scenario


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

    @classmethod
    def of_motion(cls, motion: Motion, scenario: Scenario) -> 'Signals':
        """Return the signals with one row for each variable of a motion."""
        slope = motion.slip_acceleration
        return cls(
            np.ascontiguousarray(motion.acceleration.T),
            np.ascontiguousarray(motion.torsion_speed.T),
            np.ascontiguousarray(motion.driving.T),
            None if slope is None else slope[:, np.newaxis],
            motion.start,
            window_of(scenario),
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
    """A metric that is a root mean square of a linear map of the signals."""

    of: Rows
    """Function that returns the mapped signals, (..., n)."""
    samples: int = 0
    """Number of samples of a stretch where it is the largest over all; 0: over all samples."""

    def value(self, signals: Signals) -> float | None:
        """Return the metric of a run."""
        mapped = self.of(signals)
        if mapped is None:
            return None
        return float(strongest_stretch(mapped, self.samples or mapped.shape[-1]))


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
    mapped = weighted_acceleration(signals.acceleration)[..., signals.start :]
    return mapped if mapped.shape[-1] > STEPS_PER_S else None


OBJECTIVES: Mapping[str, Objective] = {
    'peak_jerk': Peak(_jerk),
    'peak_acceleration': Peak(_acceleration),
    'traction': Peak(lambda signals: signals.driving, one_sided=True),
    'acceleration_std_m_s2': RootMeanSquare(
        lambda signals: _centred(signals.acceleration, signals)
    ),
    'torsion_speed_std_rpm': RootMeanSquare(
        lambda signals: _centred(rpm_from_rad_s(signals.torsion_speed), signals)
    ),
    'slip_acceleration_at_lock': Peak(lambda signals: signals.slip_acceleration),
    'weighted_acceleration': RootMeanSquare(_weighted, STEPS_PER_S),
}
"""Metrics by name."""
