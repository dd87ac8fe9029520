# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics of the length of a run and of its times on the wall clock."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.metrics.engagement import Engagement, Values
from ddct_bringup.metrics.metric import NO_TIMING, Metric, Null
from ddct_plant.program.table import PURE

_NO_TIMING = Null(NO_TIMING, lambda engagement: engagement.timing is None)


def update_times_us(engagement: Engagement) -> Sequence[float] | None:
    """Return the time of each update of the controller in us; None where none was measured."""
    return (engagement.timing and engagement.timing.update_times_us) or None


def update_time_median(engagement: Engagement) -> Values | None:
    """Return the median time of an update in us."""
    times = update_times_us(engagement)
    return None if times is None else np.median(times)


def update_time_p99(engagement: Engagement) -> Values | None:
    """Return the 99th percentile of the time of an update in us."""
    times = update_times_us(engagement)
    return None if times is None else np.percentile(times, 99.0)


QUANTITIES = (
    Metric(
        key='steps',
        symbol='steps',
        unit=PURE,
        form='.0f',
        meaning='length of the run in periods of 10 ms',
        value=lambda engagement: engagement.trajectory.steps,
        smaller_is_better=False,
    ),
    Metric(
        key='update_time_median_us',
        symbol='median',
        unit='us',
        form='.1f',
        meaning='median time of a controller update',
        nulls=(_NO_TIMING,),
        value=update_time_median,
        from_timing=True,
    ),
    Metric(
        key='update_time_p99_us',
        symbol='99 %',
        unit='us',
        form='.1f',
        meaning='99th percentile of the time of a controller update',
        nulls=(_NO_TIMING,),
        value=update_time_p99,
        from_timing=True,
    ),
    Metric(
        key='missed_steps',
        symbol='missed',
        unit=PURE,
        form='d',
        meaning='steps that went on without a reply',
        nulls=(_NO_TIMING,),
        value=lambda engagement: (
            None if engagement.timing is None else engagement.timing.missed_steps
        ),
        from_timing=True,
    ),
    Metric(
        key='resends',
        symbol='resends',
        unit=PURE,
        form='d',
        meaning='ticks that the driveline sent again, in lock-step',
        nulls=(_NO_TIMING,),
        value=lambda engagement: getattr(engagement.timing, 'resends', None),
        from_timing=True,
    ),
    Metric(
        key='worst_lateness_us',
        symbol='latest',
        unit='us',
        form='.1f',
        meaning='largest delay of a step of the driveline after its due time',
        nulls=(_NO_TIMING, Null('no step was timed, as in lock-step', lambda _engagement: True)),
        value=lambda engagement: (
            None if engagement.timing is None else engagement.timing.worst_lateness_us
        ),
        from_timing=True,
    ),
)
