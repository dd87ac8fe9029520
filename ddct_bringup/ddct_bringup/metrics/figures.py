# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Figures that a run is judged by, from control start to the end of the run.

In a gear shift control start is the start of the shift; its further figures are in `shift`.
"""

import math

import numpy as np

from ddct_bringup.metrics.engagement import Engagement, Values
from ddct_bringup.metrics.friction_work import (
    LEAST_SLIP_RPM,
    slips_at,
    work_of_both,
    work_over_least,
)
from ddct_bringup.metrics.metric import Metric, Null, finite
from ddct_bringup.metrics.signals.vibration import jerk, strongest_stretch, weighted_acceleration
from ddct_plant.base.timebase import PERIOD_S, STEPS_PER_S
from ddct_plant.program.table import PURE

_STRETCH_S = 1.0
"""Time over which the r.m.s. of the weighted acceleration is taken, s."""
NOT_BEGUN = Null('the run ends before control start', lambda engagement: engagement.periods < 0)
_LINEAR = Null('a linear clutch cannot lock', lambda engagement: not engagement.sticks)
_NOT_LOCKED = Null(
    'the plates are not locked at the end',
    lambda engagement: finite(engagement.whole_lockup.final_lock_s) is None,
)
ENDS_EARLY = Null('the run ends before its plan', lambda engagement: engagement.ends_early)
_NO_DEMAND = Null('there is no demand', lambda engagement: not _demand(engagement).any())
_BOTH_SIGNS = Null(
    'the demand is negative at some time', lambda engagement: bool((_demand(engagement) < 0).any())
)


def shorter_than(time_s: float) -> Null:
    """Return the condition that less than a time in s of the run is after control start."""
    return Null(
        f'the run ends less than {time_s:g} s after control start',
        lambda engagement: engagement.periods < math.ceil(time_s * STEPS_PER_S),
    )


def _demand(engagement: Engagement) -> np.ndarray:
    """Return the demand C_dem in N m in each period from control start on, (..., n)."""
    demand: np.ndarray = engagement.trajectory.torque_demand[..., engagement.control_start : -1]
    return demand


def torque_late(engagement: Engagement) -> Values:
    """
    Return the integral of max(C_dem - C_m, 0) over max C_dem in s, (...).

    C_dem and C_m of a tick apply over the period that begins with it. With no other forces the
    speed of the car lags by this time behind that of one with all of its torque.
    """
    demand = _demand(engagement)
    delivered = engagement.trajectory.engine_torque[..., engagement.control_start : -1]
    most = np.max(demand, axis=-1, initial=0.0)
    defined = (most > 0.0) & (np.min(demand, axis=-1, initial=0.0) >= 0.0)
    missing = PERIOD_S * np.sum(np.maximum(demand - delivered, 0.0), axis=-1)
    return np.where(defined, missing / np.where(defined, most, 1.0), math.nan)


def peak_jerk(engagement: Engagement) -> Values | None:
    """
    Return the largest magnitude of the jerk in m/s^3 from control start to the end, (...).

    A_x is low-passed at 20 Hz without delay. The filter starts with the run, not at control start.
    """
    if engagement.ends_early:
        return None
    found = np.abs(jerk(engagement.trajectory.vehicle_accel)[..., engagement.control_start :])
    return np.max(found, axis=-1, initial=-math.inf)


def all_friction_work(engagement: Engagement) -> Values | None:
    """Return the friction work in J of all clutches from control start on, (...)."""
    if engagement.periods < 0:
        return None
    return work_of_both(engagement.trajectory, engagement.control_start)


def largest_weighted_acceleration(engagement: Engagement) -> Values | None:
    """Return the largest r.m.s. over 1 s of A_x weighted by W_d, from control start on, (...)."""
    samples = round(_STRETCH_S * STEPS_PER_S)
    if engagement.periods < samples:
        return None
    weighted = weighted_acceleration(engagement.trajectory.vehicle_accel)
    return strongest_stretch(weighted[..., engagement.control_start :], samples)


QUANTITIES = (
    Metric(
        key='time_to_final_lock_s',
        symbol='lock',
        unit='s',
        form='.3f',
        meaning='control start to the last lock after which no release follows, 0 if the plates '
        'never part',
        nulls=(NOT_BEGUN, _LINEAR, _NOT_LOCKED),
        value=lambda engagement: engagement.whole_lockup.final_lock_s,
        figure=True,
    ),
    Metric(
        key='torque_late_s',
        symbol='torque late',
        unit='s',
        form='.3f',
        meaning='integral of max(C_dem - C_m, 0) over max C_dem: by this time the speed of the '
        'car lags behind that with all of the demand',
        nulls=(NOT_BEGUN, _NO_DEMAND, _BOTH_SIGNS),
        value=torque_late,
        needs=('torque_demand', 'engine_torque'),
        figure=True,
    ),
    Metric(
        key='peak_jerk_m_s3',
        symbol='peak jerk',
        unit='m/s^3',
        form='.2f',
        meaning='largest jerk, A_x through a 20 Hz low-pass without delay',
        nulls=(NOT_BEGUN, ENDS_EARLY),
        value=peak_jerk,
        needs=('vehicle_accel',),
        figure=True,
    ),
    Metric(
        key='friction_work_j',
        symbol='friction work',
        unit='J',
        form='.0f',
        meaning='friction work of all clutches',
        nulls=(NOT_BEGUN,),
        value=all_friction_work,
        needs=('clutch_torque',),
        figure=True,
    ),
    Metric(
        key='weighted_acceleration_m_s2',
        symbol='weighted A_x',
        unit='m/s^2',
        form='.3f',
        meaning='largest running r.m.s. over 1 s of A_x, weighted by W_d of ISO 2631-1',
        nulls=(shorter_than(_STRETCH_S),),
        value=largest_weighted_acceleration,
        needs=('vehicle_accel',),
        figure=True,
    ),
    Metric(
        key='releases',
        symbol='releases',
        unit=PURE,
        form='.0f',
        meaning='how often the plates part after control start',
        nulls=(NOT_BEGUN, _LINEAR),
        value=lambda engagement: engagement.whole_lockup.releases,
        figure=True,
    ),
    Metric(
        key='peak_jerk_over_least',
        symbol='jerk/least',
        unit=PURE,
        form='.2f',
        meaning='peak jerk over the least of a run of the clutch alone that locks once, at the '
        'time of the final lock',
        undefined='the case has no floor, the run has no final lock after the start of feedback, '
        'or it has more than 500 periods of control',
        # A convex program gives the least, after the others (`scores/floors.py`).
        value=lambda _engagement: None,
        figure=True,
    ),
    Metric(
        key='friction_work_over_least',
        symbol='work/least',
        unit=PURE,
        form='.2f',
        meaning='friction work after the start of feedback over the least for a rigid car, '
        'J_m J_eq/(J_m + J_eq) w_d^2/2 with w_d there',
        nulls=(
            Null('the plant is not known', lambda engagement: engagement.plant is None),
            Null(
                'the run ends before feedback starts',
                lambda engagement: engagement.trajectory.steps < engagement.feedback_start,
            ),
            Null(
                f'the slip is below {LEAST_SLIP_RPM:g} rpm where feedback starts',
                lambda engagement: not slips_at(engagement.trajectory, engagement.feedback_start),
            ),
        ),
        value=lambda engagement: work_over_least(
            engagement.trajectory, engagement.feedback_start, engagement.plant
        ),
        needs=('clutch_torque',),
        figure=True,
    ),
)
