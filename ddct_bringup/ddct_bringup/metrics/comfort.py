# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics and criteria of comfort: jerk, acceleration, weighted acceleration, vibration dose."""

import math

import numpy as np

from ddct_bringup.metrics.engagement import Engagement, Values
from ddct_bringup.metrics.metric import NO_WINDOW, Metric, criterion
from ddct_bringup.metrics.signals.mean_motion import (
    mean_acceleration,
    mean_jerk,
    mean_negative_jerk,
)
from ddct_bringup.metrics.signals.vibration import jerk

VDV_WEIGHTING = 'W_d of ISO 2631-1 (x axis), bilinear at 100 Hz, without its 100 Hz upper limit'
"""
Frequency weighting of the vibration dose value.

The omitted 100 Hz limit is above 50 Hz, the highest frequency in a 100 Hz recording.
"""
AXIS_FACTOR = 1.4
"""Factor of longitudinal vibration in a dose for health (2002/44/EC, Annex, part B, 1)."""
_BELOW_1_S = 'the run ends less than 1 s after control start'
_NEEDS = ('vehicle_accel',)


def peak_jerk(engagement: Engagement) -> Values | None:
    """
    Return the largest magnitude of the jerk in m/s^3 from control start to the end, (...).

    A_x is low-passed at 20 Hz without delay. The filter starts with the run, not at control start.
    None for a run that ends before the score window: it may have ended before its lock.
    """
    found = np.abs(jerk(engagement.trajectory.vehicle_accel)[..., engagement.control_start :])
    if engagement.window_samples is None:
        return None
    return np.max(found, axis=-1, initial=-math.inf)


def peak_acceleration(engagement: Engagement) -> Values:
    """Return the largest magnitude of A_x in m/s^2 after control start, (...)."""
    return np.max(np.abs(engagement.acceleration), axis=-1, initial=-math.inf)


def daily_dose(engagement: Engagement) -> Values | None:
    """Return the dose in m/s^1.75 of all engagements of a day, each with the largest dose."""
    dose = engagement.strongest[1]
    return None if dose is None else AXIS_FACTOR * dose * engagement.engagements_a_day**0.25


QUANTITIES = (
    Metric(
        key='peak_jerk_m_s3',
        symbol='peak jerk',
        unit='m/s^3',
        form='.2f',
        meaning='largest jerk from control start to the end of the run, A_x through a 20 Hz '
        'low-pass without delay',
        undefined=NO_WINDOW,
        value=peak_jerk,
        criterion='peak_jerk',
        needs=_NEEDS,
        column=True,
    ),
    criterion(
        'mean_jerk',
        'm/s^3',
        lambda engagement: mean_jerk(engagement.acceleration),
        "largest of the jerk's means over 1 s after control start",
        _BELOW_1_S,
        needs=_NEEDS,
    ),
    criterion(
        'mean_negative_jerk',
        'm/s^3',
        lambda engagement: mean_negative_jerk(engagement.acceleration),
        "most negative of the jerk's means over 1 s after control start",
        _BELOW_1_S,
        needs=_NEEDS,
    ),
    criterion(
        'mean_acceleration',
        'm/s^2',
        lambda engagement: mean_acceleration(engagement.acceleration),
        'largest mean of A_x over 2 s after control start',
        'the run ends less than 2 s after control start',
        needs=_NEEDS,
    ),
    criterion(
        'peak_acceleration',
        'm/s^2',
        peak_acceleration,
        'largest magnitude of A_x after control start',
        'the run ends before control start',
        needs=_NEEDS,
    ),
    Metric(
        key='vdv_m_s1_75',
        symbol='VDV',
        unit='m/s^1.75',
        form='.3f',
        meaning=f'vibration dose over the score window, weighted by {VDV_WEIGHTING}',
        undefined=NO_WINDOW,
        value=lambda engagement: engagement.window_dose,
        needs=_NEEDS,
    ),
    Metric(
        key='weighted_acceleration_m_s2',
        symbol='weighted A_x',
        unit='m/s^2',
        form='.3f',
        meaning='r.m.s. of A_x over the score window, weighted by W_d of ISO 2631-1',
        undefined=NO_WINDOW,
        value=lambda engagement: engagement.window_weighted_rms,
        needs=_NEEDS,
    ),
    criterion(
        'weighted_acceleration',
        'm/s^2',
        lambda engagement: engagement.strongest[0],
        'largest r.m.s. of A_x, weighted by W_d of ISO 2631-1, over any stretch after control '
        'start as long as the score window',
        NO_WINDOW,
        needs=_NEEDS,
    ),
    criterion(
        'daily_vibration_dose',
        'm/s^1.75',
        daily_dose,
        '1.4 times the largest vibration dose over any such stretch, for all engagements of a day',
        NO_WINDOW,
        needs=_NEEDS,
    ),
)
