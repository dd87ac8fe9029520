# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics of a gear shift; no other run has them."""

from collections.abc import Callable

import numpy as np

from ddct_bringup.metrics.engagement import Engagement, Values
from ddct_bringup.metrics.metric import Metric, Null, finite
from ddct_bringup.metrics.shift.course import ShiftCourse
from ddct_plant.models.driveline import LOCK, RELEASE
from ddct_plant.program.table import PURE

NO_SHIFT = 'the run is no gear shift'


def _null(reason: str, holds: Callable[[ShiftCourse], bool]) -> Null:
    """Return a condition on the course of a shift; it does not hold for other runs."""
    return Null(
        reason, lambda engagement: engagement.shift is not None and holds(engagement.shift)
    )


_NO_SHIFT = Null(NO_SHIFT, lambda engagement: engagement.shift is None)
_NOT_BEGUN = (
    _NO_SHIFT,
    _null('the run ends before the shift starts', lambda course: not course.begun),
)
_NOT_HANDED_OVER = (
    _NO_SHIFT,
    _null(
        'the share of the on-coming clutch never reaches 1', lambda course: not course.handed_over
    ),
)
_NOT_LOCKED = (
    *_NOT_HANDED_OVER,
    _null('the on-coming clutch never locks', lambda course: finite(course.lock_s) is None),
)


def _of(
    compute: Callable[[ShiftCourse], Values | None],
) -> Callable[[Engagement], Values | None]:
    """Return a metric's function, which is None for a run that is no shift."""

    def value(engagement: Engagement) -> Values | None:
        return None if engagement.shift is None else compute(engagement.shift)

    return value


def _events(key: str, symbol: str, meaning: str, kind: str, *, off_going: bool) -> Metric:
    return Metric(
        key=key,
        symbol=symbol,
        unit=PURE,
        form='.0f',
        meaning=f'{meaning} from the start of the shift on',
        nulls=_NOT_BEGUN,
        value=_of(lambda course: course.count(kind, off_going=off_going)),
        of_shift=True,
    )


QUANTITIES = (
    Metric(
        key='shift_time_s',
        symbol='shift time',
        unit='s',
        form='.3f',
        meaning='start of the shift to the first lock of the on-coming clutch in the inertia '
        'phase: torque phase and inertia phase together',
        nulls=_NOT_LOCKED,
        value=_of(lambda course: course.shift_time_s),
        of_shift=True,
        figure=True,
    ),
    Metric(
        key='torque_phase_s',
        symbol='torque phase',
        unit='s',
        form='.2f',
        meaning='start of the shift to the first tick whose share of C_fOL is 1',
        nulls=_NOT_HANDED_OVER,
        value=_of(lambda course: course.torque_phase_s),
        of_shift=True,
        figure=True,
    ),
    Metric(
        key='inertia_phase_s',
        symbol='inertia phase',
        unit='s',
        form='.3f',
        meaning='from that tick to the exact instant of the first lock of the on-coming clutch',
        nulls=_NOT_LOCKED,
        value=_of(lambda course: course.inertia_phase_s),
        of_shift=True,
        figure=True,
    ),
    Metric(
        key='torque_dip_n_m',
        symbol='wheel torque dip',
        unit='N m',
        form='.0f',
        meaning='fall of the torque of the driveshaft at the wheels, from the start of the shift '
        'to its least until the lock',
        nulls=_NOT_BEGUN,
        value=_of(lambda course: course.torque_dip),
        of_shift=True,
    ),
    Metric(
        key='torque_dip_percent',
        symbol='relative dip',
        unit='%',
        form='.0f',
        meaning='fall of the torque of the driveshaft until the lock, in % of that at the start '
        'of the shift; above 100 the car is braked',
        nulls=(
            *_NOT_BEGUN,
            _null(
                'the wheel torque does not drive the car at the start of the shift',
                lambda course: not course.wheel_torque_before > 0.0,
            ),
        ),
        value=_of(lambda course: course.torque_dip_percent),
        of_shift=True,
        figure=True,
    ),
    Metric(
        key='flare_rad_s',
        symbol='flare',
        unit='rad/s',
        form='.1f',
        meaning='largest rise of w_m above its speed in the off-going gear until the lock',
        nulls=(
            *_NOT_BEGUN,
            _null(
                'the shafts stand still at the start of the shift',
                lambda course: finite(course.flare) is None,
            ),
        ),
        value=_of(lambda course: course.flare),
        of_shift=True,
        figure=True,
    ),
    Metric(
        key='tie_up_work_j',
        symbol='tie-up work',
        unit='J',
        form='.0f',
        meaning='work of the clutches against each other: integral of the smaller torque times '
        'the difference of the shaft speeds while their torques have opposite signs',
        nulls=_NOT_BEGUN,
        value=_of(lambda course: course.tie_up_work),
        of_shift=True,
        figure=True,
    ),
    Metric(
        key='off_going_friction_work_j',
        symbol='off-going friction',
        unit='J',
        form='.0f',
        meaning='friction work of the off-going clutch, whole run',
        nulls=(_NO_SHIFT,),
        value=_of(lambda course: np.sum(course.trajectory.off_going_friction_work, axis=-1)),
        of_shift=True,
    ),
    Metric(
        key='on_coming_peak_temperature_degc',
        symbol='on-coming facing',
        unit='degC',
        form='.1f',
        meaning='highest temperature of the facing of the on-coming clutch',
        nulls=(_NO_SHIFT,),
        value=_of(lambda course: np.max(course.trajectory.clutch_temperature, axis=-1)),
        of_shift=True,
    ),
    Metric(
        key='off_going_peak_temperature_degc',
        symbol='off-going facing',
        unit='degC',
        form='.1f',
        meaning='highest temperature of the facing of the off-going clutch',
        nulls=(_NO_SHIFT,),
        value=_of(lambda course: np.max(course.trajectory.off_going_clutch_temperature, axis=-1)),
        of_shift=True,
    ),
    _events(
        'on_coming_locks',
        'on-coming locks',
        'number of locks of the on-coming clutch',
        LOCK,
        off_going=False,
    ),
    _events(
        'on_coming_releases',
        'on-coming releases',
        'how often the on-coming clutch breaks loose',
        RELEASE,
        off_going=False,
    ),
    _events(
        'off_going_locks',
        'off-going locks',
        'how often the off-going clutch locks again',
        LOCK,
        off_going=True,
    ),
    _events(
        'off_going_releases',
        'off-going releases',
        'number of releases of the off-going clutch, that of the handover among them,',
        RELEASE,
        off_going=True,
    ),
)
