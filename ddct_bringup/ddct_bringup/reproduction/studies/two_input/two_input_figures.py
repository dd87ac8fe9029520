"""What the studies of controllers of clutch and engine show of one run."""

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.reproduction.studies.scored_run import FIGURE_HEADERS, figures, metrics_of
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.program.table import text_or_dash
from ddct_plant.scenario.settings import RunSettings

CLOSE_RPM = 10.0
"""2 % of the slip at control start in the thesis scenario; a line's width in a plot of it."""
HEADERS = (
    't_a s',
    f'|w_d| < {CLOSE_RPM:g} rpm s',
    *FIGURE_HEADERS[1:],
    'w_d at end rpm',
    'C_m - demand N m',
)


def cells(settings: RunSettings, trajectory: Trajectory) -> tuple[str, ...]:
    """Return the cells below HEADERS."""
    metrics = metrics_of(settings, trajectory)
    engagement, *deviations = figures(metrics)
    start = settings.scenario.control_start_step
    return (
        engagement,
        text_or_dash(close_time_s(trajectory, start), '.2f'),
        *deviations,
        text_or_dash(metrics.slip_final_rpm, '.1f'),
        deviation_range(trajectory),
    )


def close_time_s(trajectory: Trajectory, start: int) -> float | None:
    """Return how long after step `start` |w_d| falls below CLOSE_RPM for good, None for never."""
    far = np.flatnonzero(np.abs(rpm_from_rad_s(trajectory.slip_speed)) >= CLOSE_RPM)
    last = far[-1] if far.size else -1
    return None if last == trajectory.steps else float(max(last + 1 - start, 0) * PERIOD_S)


def deviation_range(trajectory: Trajectory) -> str:
    """Return the lowest and the highest C_m - demand of a run."""
    deviation = trajectory.engine_torque - trajectory.torque_demand
    return f'{deviation.min():.0f} to {deviation.max():.0f}' if deviation.any() else '0'
