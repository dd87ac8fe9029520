# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics of Table 5.1 of the thesis, and of the slip at its end and at its lock-up."""

import numpy as np

from ddct_bringup.bag.measured_run import TORSION
from ddct_bringup.metrics.engagement import Engagement, Values
from ddct_bringup.metrics.metric import Metric, Null
from ddct_plant.base.units import rpm_from_rad_s

_NO_WINDOW = Null(
    'the run ends before the score window does',
    lambda engagement: engagement.window_samples is None,
)
_NO_CROSSING = Null(
    'w_d never changes its sign after control start, or is zero there', lambda _engagement: True
)


def torsion_speed_std(engagement: Engagement) -> Values | None:
    """Return the standard deviation (ddof 0) of w_sr in rpm over the score window, (...)."""
    if engagement.window_samples is None:
        return None
    # The deviation is converted, not the samples: the last bits of the two differ.
    torsion = engagement.trajectory.driveshaft_speed[..., engagement.window_samples]
    return rpm_from_rad_s(np.std(torsion, axis=-1))


def acceleration_std(engagement: Engagement) -> Values | None:
    """Return the standard deviation (ddof 0) of A_x in m/s^2 over the score window, (...)."""
    if engagement.window_samples is None:
        return None
    return np.std(engagement.trajectory.vehicle_accel[..., engagement.window_samples], axis=-1)


QUANTITIES = (
    Metric(
        key='engagement_time_s',
        symbol='t_a',
        unit='s',
        form='.3f',
        meaning='t_a, control start to the first change of sign of w_d; of plates that stick, to '
        'the exact instant at which they first lock or pass through zero',
        nulls=(_NO_CROSSING,),
        value=lambda engagement: engagement.lockup.engagement_time_s,
    ),
    Metric(
        key='torsion_speed_std_rpm',
        symbol='std w_sr',
        unit='rpm',
        form='.3f',
        meaning='standard deviation of w_sr over the score window',
        nulls=(_NO_WINDOW,),
        value=torsion_speed_std,
        needs=(TORSION,),
    ),
    Metric(
        key='acceleration_std_m_s2',
        symbol='std A_x',
        unit='m/s^2',
        form='.3f',
        meaning='standard deviation of A_x over the score window',
        nulls=(_NO_WINDOW,),
        value=acceleration_std,
        needs=('vehicle_accel',),
    ),
    Metric(
        key='slip_final_rpm',
        symbol='final w_d',
        unit='rpm',
        form='.2f',
        meaning='w_d at the end of the run',
        value=lambda engagement: rpm_from_rad_s(engagement.trajectory.slip_speed[..., -1]),
    ),
    Metric(
        key='lockup_slip_acceleration_rad_s2',
        symbol='dw_d/dt at lock-up',
        unit='rad/s^2',
        form='.2f',
        meaning='slope of w_d where it first changes its sign; of plates that stick, the exact '
        'one just before the first lock',
        nulls=(_NO_CROSSING,),
        value=lambda engagement: engagement.lockup.slip_acceleration,
    ),
)
