"""Figures of merit of one run, each undefined (None) rather than a stand-in number."""

import dataclasses
import math
from dataclasses import dataclass

import numpy as np
from scipy.integrate import trapezoid

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.run_timing import RunTiming
from ddct_bringup.verdict.comfort import jerk, vibration_dose, weighted_acceleration
from ddct_bringup.verdict.criteria import finite
from ddct_plant.base.timebase import PERIOD_S, steps_in
from ddct_plant.base.units import rpm_from_rad_s


@dataclass(frozen=True)
class Metrics:
    """
    The metrics of one run.

    Those over the score window take every sample from its first to its last time, both included,
    whatever comes after; they are None when the run ends before.
    """

    engagement_time_s: float | None
    """t_a (thesis Section 5.1): from control start to the first sign change of w_d, interpolated
    linearly between samples; None without one, or when w_d is zero at control start."""
    torsion_speed_std_rpm: float | None
    """Standard deviation (ddof 0) of w_sr over the score window."""
    acceleration_std_m_s2: float | None
    """Standard deviation (ddof 0) of A_x over the score window."""
    slip_rmse_rpm: float | None
    """Root of the mean square of reference less slip over the score window."""
    slip_final_rpm: float | None
    """Last sample of w_d, with its sign."""
    peak_jerk_m_s3: float | None
    """Largest magnitude of the jerk in the score window; A_x low-passed at 20 Hz without delay."""
    vdv_m_s1_75: float | None
    """Vibration dose value over the score window, weighting `metric_figures.VDV_WEIGHTING`."""
    weighted_acceleration_m_s2: float | None
    """Root of the mean square of A_x over the score window, weighted as the dose."""
    friction_energy_j: float | None
    """Friction work of the clutch over the whole run: exact where the run reports it, otherwise
    the integral of |C_f w_d| by trapezoids."""
    lockup_slip_acceleration_rad_s2: float | None
    """Slope of w_d where it first changes its sign, between the samples around it. A clutch that
    sticks makes the latter exactly zero: then between the two samples before."""
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

    def as_dict(self) -> dict[str, float | int | None]:
        """Return the metrics by name."""
        return dataclasses.asdict(self)


_OF_WINDOW = (
    'torsion_speed_std_rpm',
    'acceleration_std_m_s2',
    'slip_rmse_rpm',
    'peak_jerk_m_s3',
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
    first, last = (steps_in('score_window_s', time) for time in score_window_s)
    slip = trajectory.slip_speed
    with np.errstate(all='ignore'):  # what is not finite becomes None
        engagement_time, lockup_slope = _first_sign_change(slip, start)
        values = {
            'engagement_time_s': engagement_time,
            'lockup_slip_acceleration_rad_s2': lockup_slope,
            'slip_final_rpm': rpm_from_rad_s(slip[-1]),
            'friction_energy_j': _friction_energy(trajectory),
            'torque_total_variation_n_m': np.sum(np.abs(np.diff(trajectory.torque_request))),
            **_window_metrics(trajectory, first, last),
            **_update_times(timing),
        }
    return Metrics(
        **{name: finite(value) for name, value in values.items()},
        steps=trajectory.steps,
        missed_steps=timing.missed_steps if timing else None,
        resends=timing.resends if timing else None,
        worst_lateness_us=timing.worst_lateness_us if timing else None,
    )


def _first_sign_change(slip: np.ndarray, start: int) -> tuple[float | None, float | None]:
    """Return the time in s from step `start` to where the slip changes its sign, and its slope."""
    if start >= len(slip) or not slip[start]:
        return None, None
    changed = np.flatnonzero(slip[start:] * np.sign(slip[start]) <= 0.0)
    if not changed.size:
        return None, None
    after = start + int(changed[0])
    step = slip[after - 1] - slip[after]
    time = (after - 1 - start + slip[after - 1] / step) * PERIOD_S
    if slip[after] == 0.0 and after >= 2:
        step = slip[after - 2] - slip[after - 1]
    return time, -step / PERIOD_S


def _friction_energy(trajectory: Trajectory) -> float:
    work = trajectory.friction_work
    if work is not None:
        return np.sum(work)
    power = np.abs(trajectory.joint_effort[:, 1] * trajectory.slip_speed)
    return trapezoid(power, dx=PERIOD_S)


def _window_metrics(trajectory: Trajectory, first: int, last: int) -> dict[str, float | None]:
    """Return the metrics over the samples `first` to `last`, both included."""
    if trajectory.steps < last:
        return dict.fromkeys(_OF_WINDOW)
    window = slice(first, last + 1)
    # Filters see no sample beyond the window, so that a longer run scores the same.
    acceleration = trajectory.vehicle_accel[: last + 1]
    weighted = weighted_acceleration(acceleration)[window]
    error = (trajectory.slip_reference[:, 0] - trajectory.slip_speed)[window]
    values = (
        rpm_from_rad_s(np.std(trajectory.joint_speed[window, 3])),
        np.std(acceleration[window]),
        rpm_from_rad_s(np.sqrt(np.mean(error**2))),
        np.max(np.abs(jerk(acceleration)[first:]), initial=-math.inf),
        vibration_dose(weighted),
        np.sqrt(np.mean(weighted**2)),
    )
    return dict(zip(_OF_WINDOW, values, strict=True))


def _update_times(timing: RunTiming | None) -> dict[str, float | None]:
    if timing is None or not timing.update_times_us:
        return {'update_time_median_us': None, 'update_time_p99_us': None}
    return {
        'update_time_median_us': np.median(timing.update_times_us),
        'update_time_p99_us': np.percentile(timing.update_times_us, 99.0),
    }
