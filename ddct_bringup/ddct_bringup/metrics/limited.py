# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics that a limit applies to, besides the figures."""

import numpy as np

from ddct_bringup.bag.measured_run import TORSION
from ddct_bringup.metrics.engagement import Engagement, Values
from ddct_bringup.metrics.figures import NOT_BEGUN, shorter_than
from ddct_bringup.metrics.metric import Metric, Null
from ddct_bringup.metrics.signals.integrals import running_integral
from ddct_bringup.metrics.signals.vibration import SHORTEST_JUDDER_S, judder_of
from ddct_plant.base.timebase import PERIOD_S, STEPS_PER_S
from ddct_plant.base.units import rpm_from_rad_s

_ACCELERATION_S, _JERK_S = 2.0, 1.0
"""Averaging times of the acceleration and of the jerk in ISO 15622, s."""


def peak_temperature(engagement: Engagement) -> Values:
    """Return the highest temperature in degC of the facing, (...), of both in a gear shift."""
    run = engagement.trajectory
    highest: np.ndarray = np.max(run.clutch_temperature, axis=-1)
    if engagement.shift is None:
        return highest
    return np.maximum(highest, np.max(run.off_going_clutch_temperature, axis=-1))


def mean_acceleration(engagement: Engagement) -> Values | None:
    """Return the largest mean of A_x over 2 s after control start in m/s^2, (...)."""
    samples = round(_ACCELERATION_S * STEPS_PER_S)
    if engagement.periods < samples:
        return None
    acceleration = engagement.trajectory.vehicle_accel[..., engagement.control_start :]
    speed = running_integral(acceleration)
    return np.max(speed[..., samples:] - speed[..., :-samples], axis=-1) / _ACCELERATION_S


def mean_negative_jerk(engagement: Engagement) -> Values | None:
    """Return the most negative mean of the jerk over 1 s in m/s^3, (...), 0 without one."""
    samples = round(_JERK_S * STEPS_PER_S)
    if engagement.periods < samples:
        return None
    acceleration = engagement.trajectory.vehicle_accel[..., engagement.control_start :]
    means = (acceleration[..., samples:] - acceleration[..., :-samples]) / _JERK_S
    return np.minimum(np.min(means, axis=-1), 0.0)


def driving_acceleration(engagement: Engagement) -> Values | None:
    """
    Return the largest driving force at the wheels over the mass of the car, m/s^2, whole run.

    The force is the driveshaft torque divided by the wheel radius. None without a plant.
    """
    if engagement.plant is None:
        return None
    torque = np.max(engagement.trajectory.driveshaft_effort, axis=-1)
    return torque / (engagement.plant.wheel_radius * engagement.plant.mass)


def judder(engagement: Engagement) -> Values:
    """Return the r.m.s. in rpm of w_sr from 2 to 20 Hz while the clutch slips, (...)."""
    first, after = engagement.lockup.slipping
    return judder_of(rpm_from_rad_s(engagement.trajectory.driveshaft_speed), first, after)


def _slips_shortly(engagement: Engagement) -> bool:
    first, after = engagement.lockup.slipping
    return bool((after - first - 1) * PERIOD_S < SHORTEST_JUDDER_S)


QUANTITIES = (
    Metric(
        key='peak_temperature_degc',
        symbol='facing',
        unit='degC',
        form='.1f',
        meaning='highest temperature of the facing, in a gear shift of both facings',
        nulls=(Null('the clutch is linear', lambda engagement: not engagement.sticks),),
        value=peak_temperature,
        signals=('clutch_temperature',),
    ),
    Metric(
        key='driving_acceleration_m_s2',
        symbol='traction',
        unit='m/s^2',
        form='.2f',
        meaning='largest driving force at the wheels over the mass of the car',
        nulls=(Null('the plant is not known', lambda engagement: engagement.plant is None),),
        value=driving_acceleration,
        needs=('driveshaft_torque',),
    ),
    Metric(
        key='mean_acceleration_m_s2',
        symbol='mean A_x',
        unit='m/s^2',
        form='.2f',
        meaning='largest mean of A_x over 2 s after control start',
        nulls=(shorter_than(_ACCELERATION_S),),
        value=mean_acceleration,
        needs=('vehicle_accel',),
    ),
    Metric(
        key='mean_negative_jerk_m_s3',
        symbol='mean negative jerk',
        unit='m/s^3',
        form='.2f',
        meaning="most negative of the jerk's means over 1 s after control start",
        nulls=(shorter_than(_JERK_S),),
        value=mean_negative_jerk,
        needs=('vehicle_accel',),
    ),
    Metric(
        key='judder_rpm',
        symbol='judder',
        unit='rpm',
        form='.2f',
        meaning='r.m.s. of w_sr from 2 to 20 Hz from the first to the last sample of slipping '
        'after the start of feedback, of a linear clutch before t_a',
        nulls=(
            NOT_BEGUN,
            Null(
                f'the clutch slips for less than {SHORTEST_JUDDER_S:g} s after the start of '
                'feedback',
                _slips_shortly,
            ),
        ),
        value=judder,
        needs=(TORSION,),
    ),
)
