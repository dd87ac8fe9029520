# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics and criteria of the clutch: friction work, temperature, lock-up."""

import numpy as np

from ddct_bringup.metrics.engagement import Engagement, Values
from ddct_bringup.metrics.friction_work import (
    LEAST_SLIP_RPM,
    friction_work,
    slips_at,
    work_over_least,
)
from ddct_bringup.metrics.metric import NOT_FINITE, Metric, criterion
from ddct_bringup.metrics.slip import NO_LOCK

NO_LOCKUP = (
    'after control start the plates never came together, or they were together there already, or '
    'the bag was recorded before locks had a slip acceleration'
)


def peak_temperature(engagement: Engagement) -> Values:
    """Return the highest temperature in degC of the facing, in a gear shift of both facings."""
    run = engagement.trajectory
    highest = np.max(run.clutch_temperature)
    if engagement.shift is None:
        return highest
    return max(highest, np.max(run.off_going_clutch_temperature))


QUANTITIES = (
    Metric(
        key='friction_energy_j',
        symbol='friction energy',
        unit='J',
        form='.0f',
        meaning='friction work of the clutch, whole run',
        undefined=NOT_FINITE,
        value=lambda engagement: friction_work(engagement.trajectory),
        criterion='friction_energy',
        needs=('clutch_torque',),
    ),
    criterion(
        'friction_work_over_least',
        '1',
        lambda engagement: work_over_least(
            engagement.trajectory, engagement.feedback_start, engagement.plant
        ),
        'friction work after control start over the least for a rigid car, '
        'J_m J_eq/(J_m + J_eq) w_d^2/2 with w_d at control start',
        f'the slip at control start is below {LEAST_SLIP_RPM:g} rpm, or the plant is not known',
        exists=lambda engagement: slips_at(engagement.trajectory, engagement.feedback_start),
        needs=('clutch_torque',),
    ),
    criterion(
        'peak_temperature',
        'degC',
        peak_temperature,
        'highest temperature of the facing, in a gear shift of both facings',
        'the clutch is linear',
        exists=lambda engagement: engagement.sticks,
        signals=('clutch_temperature',),
    ),
    Metric(
        key='lockup_slip_acceleration_rad_s2',
        symbol='dw_d/dt at lock-up',
        unit='rad/s^2',
        form='.2f',
        meaning='slope of w_d where it first changes its sign; of plates that stick, the exact '
        'one just before the first lock',
        undefined=NO_LOCKUP,
        value=lambda engagement: engagement.lockup.slip_acceleration,
        criterion='slip_acceleration_at_lock',
    ),
    criterion(
        'releases_after_lock',
        '1',
        lambda engagement: engagement.lockup.releases,
        'how often the plates part again',
        NO_LOCK,
        exists=lambda engagement: engagement.sticks,
    ),
)
