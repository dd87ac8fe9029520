# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics of the slip and of Table 5.1: engagement time, deviations, slip error."""

import numpy as np

from ddct_bringup.bag.measured_run import TORSION
from ddct_bringup.metrics.engagement import Engagement, Values
from ddct_bringup.metrics.metric import NO_WINDOW, NOT_FINITE, Metric, criterion
from ddct_plant.base.units import rpm_from_rad_s

NO_CROSSING = 'after control start w_d never changed its sign, or it was zero there'
NO_LOCK = 'the clutch is linear, or never locked after control start'


def torsion_speed_std(engagement: Engagement) -> Values | None:
    """Return the standard deviation (ddof 0) of w_sr in rpm over the score window, (...)."""
    if engagement.window_samples is None:
        return None
    # The deviation is converted, not the samples: the last bits of the two differ.
    torsion = engagement.torsion_speed[..., engagement.window_samples]
    return rpm_from_rad_s(np.std(torsion, axis=-1))


def acceleration_std(engagement: Engagement) -> Values | None:
    """Return the standard deviation (ddof 0) of A_x in m/s^2 over the score window, (...)."""
    if engagement.window_samples is None:
        return None
    return np.std(engagement.trajectory.vehicle_accel[..., engagement.window_samples], axis=-1)


def slip_rmse(engagement: Engagement) -> Values | None:
    """Return the root mean square of reference minus slip in rpm over the score window, (...)."""
    if engagement.window_samples is None:
        return None
    run = engagement.trajectory
    error = (run.at_tick('slip_reference') - run.slip_speed)[..., engagement.window_samples]
    return rpm_from_rad_s(np.sqrt(np.mean(error**2, axis=-1)))


QUANTITIES = (
    criterion(
        'time_to_lock',
        's',
        lambda engagement: engagement.lockup.time_to_lock_s,
        'control start to the first lock',
        f'{NO_LOCK}, or was locked there',
        exists=lambda engagement: engagement.sticks,
    ),
    Metric(
        key='engagement_time_s',
        symbol='t_a',
        unit='s',
        form='.3f',
        meaning='t_a, control start to the first change of sign of w_d; of plates that stick, to '
        'the exact instant at which they first lock or pass through zero',
        undefined=NO_CROSSING,
        value=lambda engagement: engagement.lockup.engagement_time_s,
        criterion='engagement_time',
        column=True,
    ),
    Metric(
        key='torsion_speed_std_rpm',
        symbol='std w_sr',
        unit='rpm',
        form='.3f',
        meaning='standard deviation of w_sr over the score window',
        undefined=NO_WINDOW,
        value=torsion_speed_std,
        needs=(TORSION,),
        column=True,
    ),
    Metric(
        key='acceleration_std_m_s2',
        symbol='std A_x',
        unit='m/s^2',
        form='.3f',
        meaning='standard deviation of A_x over the score window',
        undefined=NO_WINDOW,
        value=acceleration_std,
        needs=('vehicle_accel',),
        column=True,
    ),
    Metric(
        key='slip_rmse_rpm',
        symbol='RMSE w_d',
        unit='rpm',
        form='.2f',
        meaning='root mean square of reference less w_d over the score window',
        undefined=NO_WINDOW,
        value=slip_rmse,
        needs=('slip_reference',),
        column=True,
    ),
    Metric(
        key='slip_final_rpm',
        symbol='final w_d',
        unit='rpm',
        form='.2f',
        meaning='w_d at the end of the run',
        undefined=NOT_FINITE,
        value=lambda engagement: rpm_from_rad_s(engagement.trajectory.slip_speed[..., -1]),
        column=True,
    ),
)
