# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics of one run; a metric that is undefined is None, never a placeholder number."""

import math
from collections.abc import Mapping

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_bringup.verdict.criteria import finite
from ddct_bringup.verdict.friction_work import friction_work
from ddct_bringup.verdict.vibration import jerk, vibration_dose, weighted_acceleration
from ddct_bringup.verdict.zero_slip import first_lock, first_zero_slip
from ddct_plant.base.timebase import PERIOD_S, steps_in, time_of_step
from ddct_plant.base.units import rpm_from_rad_s

Metrics = Mapping[str, float | int | None]
"""Value of every metric by its key in `scores.json`; None where it is undefined."""
METRIC_NAMES = (
    'engagement_time_s',
    'torsion_speed_std_rpm',
    'acceleration_std_m_s2',
    'slip_rmse_rpm',
    'slip_final_rpm',
    'peak_jerk_m_s3',
    'vdv_m_s1_75',
    'weighted_acceleration_m_s2',
    'friction_energy_j',
    'lockup_slip_acceleration_rad_s2',
    'torque_total_variation_n_m',
    'steps',
    'update_time_median_us',
    'update_time_p99_us',
    'missed_steps',
    'resends',
    'worst_lateness_us',
)
_OF_WINDOW = (
    'torsion_speed_std_rpm',
    'acceleration_std_m_s2',
    'slip_rmse_rpm',
    'vdv_m_s1_75',
    'weighted_acceleration_m_s2',
)


def compute_metrics(
    trajectory: Trajectory,
    *,
    control_start_s: float,
    score_window_s: tuple[float, float],
    timing: RunTiming | None = None,
) -> Metrics:
    """Compute every metric; times are scenario times in s, multiples of 10 ms."""
    start = steps_in('control_start_s', control_start_s)
    window = tuple(steps_in('score_window_s', time) for time in score_window_s)
    values = {
        **metric_values(trajectory, start, window),
        **_update_times(timing),
        'steps': trajectory.steps,
        'missed_steps': timing.missed_steps if timing else None,
        'resends': timing.resends if timing else None,
        'worst_lateness_us': timing.worst_lateness_us if timing else None,
    }
    return {name: finite(values[name]) for name in METRIC_NAMES}


def metric_values(
    trajectory: Trajectory, start: int, window: tuple[int, ...]
) -> dict[str, np.ndarray]:
    """
    Return the metrics of the trajectory by name, (...), not finite where undefined.

    Signals may be stacks, (..., N+1), of runs of one length. Control starts at step `start`;
    `window` is the first and the last scored step.
    """
    slip = trajectory.slip_speed
    with np.errstate(all='ignore'):  # what is not finite becomes None
        engagement_time, lockup_slope = _first_sign_change(slip, start)
        if trajectory.phase_events is not None:
            engagement_time = _zero_slip_time(trajectory, start, engagement_time)
            lockup_slope = _slip_acceleration_at_lock(trajectory, start)
        return {
            'engagement_time_s': engagement_time,
            'lockup_slip_acceleration_rad_s2': lockup_slope,
            'slip_final_rpm': rpm_from_rad_s(slip[..., -1]),
            'friction_energy_j': friction_work(trajectory),
            'torque_total_variation_n_m': np.sum(
                np.abs(np.diff(trajectory.torque_request)), axis=-1
            ),
            'peak_jerk_m_s3': _peak_jerk(trajectory, start, window[1]),
            **_window_metrics(trajectory, *window),
        }


def _first_sign_change(slip: np.ndarray, start: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the time in s from `start` to the first sign change of the slip, and its slope."""
    if start >= slip.shape[-1]:
        never = np.full(slip.shape[:-1], math.nan)
        return never, never
    changed = slip[..., start:] * np.sign(slip[..., start : start + 1]) <= 0.0
    after = start + np.argmax(changed, axis=-1)
    # Without a sign change argmax returns `start`, as it does where the slip is zero at `start`.
    found = after > start
    last, before = (_at(slip, np.maximum(after - back, 0)) for back in range(2))
    step = before - last
    time = (after - 1 - start + before / step) * PERIOD_S
    return np.where(found, time, math.nan), np.where(found, -step / PERIOD_S, math.nan)


def _zero_slip_time(trajectory: Trajectory, start: int, crossing_s: np.ndarray) -> np.ndarray:
    """
    Return the time in s from step `start` to the first lock or reversal, NaN without one.

    `crossing_s` is the time of the first sign change of the samples. It is returned where a bag
    from before reversals were events has a sign change without an event.
    """
    found = first_zero_slip(trajectory, start)
    if found is None:
        return crossing_s
    step, event = found
    earlier = crossing_s <= time_of_step(step - 1 - start)
    return crossing_s if earlier else np.array(event.time_s - time_of_step(start))


def _slip_acceleration_at_lock(trajectory: Trajectory, start: int) -> np.ndarray:
    """Return dw_d/dt in rad/s^2 at the first lock after step `start`, NaN where unknown."""
    lock = first_lock(trajectory, start)
    return np.array(math.nan if lock is None else lock.slip_acceleration, dtype=float)


def _at(values: np.ndarray, index: np.ndarray) -> np.ndarray:
    return np.take_along_axis(values, index[..., np.newaxis], axis=-1)[..., 0]


def _peak_jerk(trajectory: Trajectory, start: int, last_scored: int) -> np.ndarray:
    """
    Return the largest magnitude of the jerk from step `start` on, NaN for a run that ends early.

    The filter starts with the run, not at `start`. A run that ends before `last_scored` may have
    ended before its lock.
    """
    found = np.abs(jerk(trajectory.vehicle_accel)[..., start:])
    if trajectory.steps < last_scored:
        return np.full(found.shape[:-1], math.nan)
    return np.max(found, axis=-1, initial=-math.inf)


def _window_metrics(trajectory: Trajectory, first: int, last: int) -> dict[str, np.ndarray]:
    """Return the metrics over the samples `first` to `last`, both included."""
    if trajectory.steps < last:
        runs = trajectory.slip_speed.shape[:-1]
        return dict.fromkeys(_OF_WINDOW, np.full(runs, math.nan))
    window = slice(first, last + 1)
    # The filters get no sample after the window, so a longer run has the same metrics.
    acceleration = trajectory.vehicle_accel[..., : last + 1]
    weighted = weighted_acceleration(acceleration)[..., window]
    error = (trajectory.at_tick('slip_reference') - trajectory.slip_speed)[..., window]
    values = (
        rpm_from_rad_s(np.std(trajectory.driveshaft_speed[..., window], axis=-1)),
        np.std(acceleration[..., window], axis=-1),
        rpm_from_rad_s(np.sqrt(np.mean(error**2, axis=-1))),
        vibration_dose(weighted),
        np.sqrt(np.mean(weighted**2, axis=-1)),
    )
    return dict(zip(_OF_WINDOW, values, strict=True))


def _update_times(timing: RunTiming | None) -> dict[str, float | None]:
    if timing is None or not timing.update_times_us:
        return {'update_time_median_us': None, 'update_time_p99_us': None}
    return {
        'update_time_median_us': np.median(timing.update_times_us),
        'update_time_p99_us': np.percentile(timing.update_times_us, 99.0),
    }
