"""Figures of merit of one run, each undefined (None) rather than a stand-in number."""

import math
from typing import NamedTuple

import numpy as np
import scipy

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.beside_bag import RunTiming
from ddct_bringup.verdict.criteria import finite
from ddct_bringup.verdict.meeting import first_lock, first_meeting
from ddct_bringup.verdict.vibration import jerk, vibration_dose, weighted_acceleration
from ddct_plant.base.timebase import PERIOD_S, steps_in, time_of_step
from ddct_plant.base.units import rpm_from_rad_s


class Metrics(NamedTuple):
    """
    The metrics of one run.

    Those over the score window take every sample from its first to its last time, both included,
    whatever comes after; they are None when the run ends before.
    """

    engagement_time_s: float | None
    """t_a (thesis Section 5.1): from control start to the first sign change of w_d, interpolated
    linearly between samples; None without one, or when w_d is zero at control start. Of a clutch
    that sticks to the instant of the first lock, or of passing through zero."""
    torsion_speed_std_rpm: float | None
    """Standard deviation (ddof 0) of w_sr over the score window."""
    acceleration_std_m_s2: float | None
    """Standard deviation (ddof 0) of A_x over the score window."""
    slip_rmse_rpm: float | None
    """Root of the mean square of reference less slip over the score window."""
    slip_final_rpm: float | None
    """Last sample of w_d, with its sign."""
    peak_jerk_m_s3: float | None
    """Largest magnitude of the jerk from control start to the end of the run; A_x low-passed at
    20 Hz without delay. None too when the run ends before the score window does."""
    vdv_m_s1_75: float | None
    """Vibration dose value over the score window, weighting `metric_figures.VDV_WEIGHTING`."""
    weighted_acceleration_m_s2: float | None
    """Root of the mean square of A_x over the score window, weighted as the dose."""
    friction_energy_j: float | None
    """Friction work of the clutch over the whole run: exact where the run reports it, otherwise
    the integral of |C_f w_d| by trapezoids."""
    lockup_slip_acceleration_rad_s2: float | None
    """Slope of w_d where it first changes its sign, between the samples around it. Of a clutch
    that sticks the exact one just before the first lock after control start."""
    torque_total_variation_n_m: float | None
    """Sum of the magnitudes of all changes of the clutch torque request over the whole run."""
    steps: int
    """Periods integrated."""
    update_time_median_us: float | None
    """Median time of a controller update; this and what follows is None without timing.json."""
    update_time_p99_us: float | None
    """99th percentile of the same."""
    missed_steps: int | None
    """Steps that went on without a reply, in real time."""
    resends: int | None
    """Ticks that the owner of time sent again, in lock-step."""
    worst_lateness_us: float | None
    """How much too late the driveline took a step at most, in real time; None in lock-step."""


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
    values = {**metric_values(trajectory, start, window), **_update_times(timing)}
    return Metrics(
        **{name: finite(value) for name, value in values.items()},
        steps=trajectory.steps,
        missed_steps=timing.missed_steps if timing else None,
        resends=timing.resends if timing else None,
        worst_lateness_us=timing.worst_lateness_us if timing else None,
    )


def metric_values(
    trajectory: Trajectory, start: int, window: tuple[int, ...]
) -> dict[str, np.ndarray]:
    """
    Return every metric of the trajectory itself by name, (...), not finite where undefined.

    Signals may be stacks, (..., N+1), of runs of one length. Control starts at step `start`;
    `window` is the first and the last scored step.
    """
    slip = trajectory.slip_speed
    with np.errstate(all='ignore'):  # what is not finite becomes None
        engagement_time, lockup_slope = _first_sign_change(slip, start)
        if trajectory.phase_events is not None:
            engagement_time = _first_meeting_time(trajectory, start, engagement_time)
            lockup_slope = _slip_acceleration_at_lock(trajectory, start)
        return {
            'engagement_time_s': engagement_time,
            'lockup_slip_acceleration_rad_s2': lockup_slope,
            'slip_final_rpm': rpm_from_rad_s(slip[..., -1]),
            'friction_energy_j': _friction_energy(trajectory),
            'torque_total_variation_n_m': np.sum(
                np.abs(np.diff(trajectory.torque_request)), axis=-1
            ),
            'peak_jerk_m_s3': _peak_jerk(trajectory, start, window[1]),
            **_window_metrics(trajectory, *window),
        }


def _first_sign_change(slip: np.ndarray, start: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the time in s from step `start` to where the slip changes its sign, and its slope."""
    if start >= slip.shape[-1]:
        never = np.full(slip.shape[:-1], math.nan)
        return never, never
    changed = slip[..., start:] * np.sign(slip[..., start : start + 1]) <= 0.0
    after = start + np.argmax(changed, axis=-1)
    # Without a change the first one seems to be at `start`, as it is where the slip is zero there.
    found = after > start
    last, before = (_at(slip, np.maximum(after - back, 0)) for back in range(2))
    step = before - last
    time = (after - 1 - start + before / step) * PERIOD_S
    return np.where(found, time, math.nan), np.where(found, -step / PERIOD_S, math.nan)


def _first_meeting_time(trajectory: Trajectory, start: int, crossing_s: np.ndarray) -> np.ndarray:
    """
    Return the time in s from step `start` to the first lock or reversal, NaN without.

    `crossing_s` is that of the first change of sign of the samples. Bags recorded before reversals
    were events may have one without an event; then it stands.
    """
    found = first_meeting(trajectory, start)
    if found is None:
        return crossing_s
    step, event = found
    earlier = crossing_s <= time_of_step(step - 1 - start)
    return crossing_s if earlier else np.array(event.time_s - time_of_step(start))


def _slip_acceleration_at_lock(trajectory: Trajectory, start: int) -> np.ndarray:
    """Return that of the first lock after step `start` in rad/s^2, NaN where it is not known."""
    lock = first_lock(trajectory, start)
    return np.array(math.nan if lock is None else lock.slip_acceleration, dtype=float)


def _at(values: np.ndarray, index: np.ndarray) -> np.ndarray:
    return np.take_along_axis(values, index[..., np.newaxis], axis=-1)[..., 0]


def _friction_energy(trajectory: Trajectory) -> np.ndarray:
    work = trajectory.friction_work
    if work is not None:
        return np.sum(work, axis=-1)
    power = np.abs(trajectory.joint_effort[..., 1] * trajectory.slip_speed)
    return scipy.integrate.trapezoid(power, dx=PERIOD_S)


def _peak_jerk(trajectory: Trajectory, start: int, last_scored: int) -> np.ndarray:
    """
    Return the largest magnitude of the jerk from step `start` on, NaN for a run that ends early.

    The filter begins with the run, not at `start`. A run that ends before `last_scored` may have
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
    # Filters see no sample beyond the window, so that a longer run scores the same.
    acceleration = trajectory.vehicle_accel[..., : last + 1]
    weighted = weighted_acceleration(acceleration)[..., window]
    error = (trajectory.slip_reference[..., 0] - trajectory.slip_speed)[..., window]
    values = (
        rpm_from_rad_s(np.std(trajectory.joint_speed[..., window, 3], axis=-1)),
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
