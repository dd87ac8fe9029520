# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
State of a run: whether it engaged, and if not what went wrong.

The first that applies:

    invalid          the run does not count
    tied_up          the clutches of a gear shift worked against each other
    stalled, over_revved   the engine left its limits, which ends the run
    not_engaged      the plates slip at the end
    flared           the engine ran up between the gears of a shift
    late             the plates are locked at the end, but not for long enough
    withheld, added  the controller commands the engine, and takes the driver's torque away or
                     adds to it
    engaged          the only success

The thresholds are those of a limits file.
"""

from typing import NamedTuple

import numpy as np

from ddct_bringup.metrics.engagement import Engagement
from ddct_bringup.verdict.rules import Rules
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.models.engine_limits import OVER_REVVED, STALLED

ENGAGED, LATE, WITHHELD, ADDED = 'engaged', 'late', 'withheld', 'added'
NOT_ENGAGED, TIED_UP, FLARED, INVALID = 'not_engaged', 'tied_up', 'flared', 'invalid'
STATES = (
    ENGAGED,
    LATE,
    WITHHELD,
    ADDED,
    NOT_ENGAGED,
    STALLED,
    OVER_REVVED,
    TIED_UP,
    FLARED,
    INVALID,
)
_ROUNDING_S = 1e-9
"""Difference of two times in s that is rounding."""


class State(NamedTuple):
    """State of a run."""

    name: str
    """One of `STATES`."""
    why: str = ''
    """Reason in a few words, with the values that decide; empty where the name says all."""


def state_of(engagement: Engagement, engine_end: str | None, rules: Rules) -> State:
    """
    Return the state of a valid run.

    `engine_end` is STALLED or OVER_REVVED where the engine ended the run.
    """
    tied_up = _tie_up(engagement, rules)
    if tied_up:
        return tied_up
    if engine_end:
        return State(engine_end)
    return (
        _not_engaged(engagement, rules)
        or _flare(engagement, rules)
        or _late(engagement, rules)
        or _engine_command(engagement, rules)
        or State(ENGAGED)
    )


def _tie_up(engagement: Engagement, rules: Rules) -> State | None:
    work = (engagement.shift and engagement.shift.tie_up_work) or 0.0
    if work <= rules.tie_up_work_j:
        return None
    return State(
        TIED_UP,
        f'the clutches do {work:.0f} J against each other, more than {rules.tie_up_work_j:g} J',
    )


def _flare(engagement: Engagement, rules: Rules) -> State | None:
    rise = (engagement.shift and engagement.shift.flare) or 0.0
    if rise <= rules.flare_rad_s:
        return None
    return State(
        FLARED,
        f'the engine rises by {rise:.1f} rad/s between the gears, '
        f'more than {rules.flare_rad_s:g} rad/s',
    )


def _not_engaged(engagement: Engagement, rules: Rules) -> State | None:
    slip = engagement.trajectory.slip_speed
    if engagement.sticks:
        if engagement.whole_lockup.final_lock_s is not None:
            return None
        releases = engagement.whole_lockup.releases or 0
        after = f' after {releases} release{"s" * (releases > 1)}' if releases else ''
        slip_rpm = rpm_from_rad_s(slip[-1])
        return State(
            NOT_ENGAGED, f'the plates are not locked at the end: slip {slip_rpm:.1f} rpm{after}'
        )
    outside = np.flatnonzero(np.abs(slip) > rules.engaged_slip_rad_s)
    first = int(outside[-1]) + 1 if outside.size else 0
    within_s = (len(slip) - 1 - first) * PERIOD_S
    if within_s >= rules.settled_time - _ROUNDING_S:
        return None
    return State(
        NOT_ENGAGED,
        f'the slip, {rpm_from_rad_s(slip[-1]):.1f} rpm at the end, is not within '
        f'{rules.engaged_slip:g} rpm over the last {rules.settled_time:g} s',
    )


def _late(engagement: Engagement, rules: Rules) -> State | None:
    lock_s = engagement.whole_lockup.final_lock_s
    if not lock_s:  # a linear clutch, or plates that never part
        return None
    locked_s = engagement.periods * PERIOD_S - lock_s
    if locked_s >= rules.locked_time - _ROUNDING_S:
        return None
    return State(
        LATE,
        f'the plates are locked for the last {locked_s:.2f} s, less than {rules.locked_time:g} s',
    )


def _engine_command(engagement: Engagement, rules: Rules) -> State | None:
    """Return WITHHELD or ADDED for a controller that commands the engine beyond the rules."""
    command = EngineCommand.of(engagement, rules)
    if command is None:
        return None
    if command.withheld_s > rules.withheld_time:
        return State(
            WITHHELD,
            f'the controller takes {command.withheld_s:.2f} s of the largest demand away, more '
            f'than {rules.withheld_time:g} s',
        )
    if command.delivered_share < rules.delivered_share:
        return State(
            WITHHELD,
            f'the controller requests {100.0 * command.delivered_share:.0f} % of the demand over '
            f'the last {rules.delivered_time:g} s, less than {100.0 * rules.delivered_share:g} %',
        )
    if command.added_s > rules.added_time:
        return State(
            ADDED,
            f'the controller adds {command.added_s:.2f} s of the largest demand, more than '
            f'{rules.added_time:g} s',
        )
    return None


class EngineCommand(NamedTuple):
    """What a controller that commands the engine does with the demand of the driver."""

    withheld_s: float
    """Integral of max(C_dem - C_cut - max(C_req, C_m), 0) over max C_dem, s."""
    added_s: float
    """Integral of max(min(C_m, C_req) - C_dem, 0) over max C_dem, s."""
    delivered_share: float
    """Share of the demand that is requested or given over the last `delivered_time`."""

    @classmethod
    def of(cls, engagement: Engagement, rules: Rules) -> 'EngineCommand | None':
        """
        Return these of a run; None where the controller does not command the engine.

        None too where there is no positive demand that it could take away. C_req is its request,
        and C_m what the engine gives: it does not withhold what the torque cut C_cut of a handover
        takes, nor what idle control gives above its request, and by a negative request that the
        engine cannot follow no more than the demand.
        """
        run, start = engagement.trajectory, engagement.control_start
        if not run.two_input or engagement.periods < 1:
            return None
        demand, torque, request = (
            values[start:-1]
            for values in (run.torque_demand, run.engine_torque, run.engine_torque_request)
        )
        most = float(np.max(demand))
        if not most > 0.0:
            return None
        last = round(rules.delivered_time / PERIOD_S)
        highest, lowest = np.maximum(request, torque), np.minimum(request, torque)
        wanted = demand if run.torque_cut is None else demand - run.torque_cut[start:-1]
        given = float(np.sum(np.minimum(highest, wanted)[-last:]))
        at_end = float(np.sum(wanted[-last:]))
        return cls(
            PERIOD_S * float(np.sum(np.maximum(wanted - highest, 0.0))) / most,
            PERIOD_S * float(np.sum(np.maximum(lowest - demand, 0.0))) / most,
            given / at_end if at_end > 0.0 else 1.0,
        )
