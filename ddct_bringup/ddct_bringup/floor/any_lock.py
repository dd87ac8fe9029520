# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The least of a metric whenever the plates lock: above a limit, no controller can keep it."""

import dataclasses
from collections.abc import Sequence

import numpy as np

from ddct_bringup.floor.case import Case, case_at
from ddct_bringup.floor.dynamics.start import Start
from ddct_bringup.floor.dynamics.tube import Tube
from ddct_bringup.floor.floor import floor_of_case
from ddct_bringup.floor.lock import SETTLED_S
from ddct_bringup.floor.values import Floor
from ddct_plant.scenario.settings import RunSettings

_SHARES = (1.0, 0.75, 0.55, 0.4, 0.25, 0.1)
"""Lock times of plates that stick, as shares of the latest one."""
_FASTER = 10.0
"""Largest excess of w_r over its band here in rad/s, about 3 m/s of the car."""


def lock_times(settings: RunSettings, start: Start) -> Sequence[float]:
    """
    Return the lock times in s from control start whose floors are compared, the latest first.

    For a linear clutch the latest is enough: a run that keeps within the band from an earlier time
    on does so from the latest on too. In a gear shift the off-going clutch is open at each.
    """
    latest = (settings.scenario.steps - start.step) / 100.0 - SETTLED_S
    shares = _SHARES if settings.stick_slip else _SHARES[:1]
    times = [round(share * latest, 2) for share in shares]
    return [time for time in times if not start.off_going or time > start.off_going.open_s]


def least_at_any_lock(
    settings: RunSettings, metric: str, start: Start, limit: float
) -> Floor | None:
    """
    Return the lowest of the floors at `lock_times`, None unless all are above `limit`.

    The car may be at rest, or faster than near a rigid car. Where the engine has limits, its
    torque is a variable: other controllers may reach them, or stay away.
    """
    lowest = None
    limited = settings.scenario.engine_limits is not None
    for time_s in lock_times(settings, start):
        if limited and not _above(_case(settings, start, time_s, limited=False), metric, limit):
            return None  # a floor that covers more runs is lower
        floor = _above(_case(settings, start, time_s, limited=limited), metric, limit)
        if floor is None:
            return None
        if floor.least is not None and (lowest is None or floor.least < (lowest.least or 0.0)):
            lowest = floor
    return lowest


def _above(case: Case, metric: str, limit: float) -> Floor | None:
    """Return the floor of a case, None where it is not above the limit."""
    floor = floor_of_case(case, metric)
    return floor if floor.least is None or floor.least > limit else None


def _case(settings: RunSettings, start: Start, time_s: float, *, limited: bool) -> Case:
    case = case_at(settings, start, time_s, limited=limited)
    return dataclasses.replace(case, tube=_any_speed(case.tube))


def _any_speed(tube: Tube) -> Tube:
    """Return a band with the speeds of the car from rest to above those of a rigid one."""
    return dataclasses.replace(
        tube,
        wheel_low=np.minimum(tube.wheel_low, 0.0),
        wheel_high=tube.wheel_high + _FASTER,
    )
