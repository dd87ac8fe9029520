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

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ddct_bringup.metrics.engagement import Engagement, Values
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
    (state,) = states_of(engagement, [engine_end], rules)
    return state


def states_of(
    engagement: Engagement, engine_ends: Sequence[str | None], rules: Rules
) -> list[State]:
    """Return the state of each of R valid runs, or of one; `engine_ends` are as in `state_of`."""
    columns = [
        np.broadcast_to(values, len(engine_ends)).tolist()
        for values in Decisive.of(engagement, rules)
    ]
    runs = map(Decisive._make, zip(*columns, strict=True))
    return [_state(run, end, rules) for run, end in zip(runs, engine_ends, strict=True)]


class Decisive(NamedTuple):
    """
    Values that decide the state: (R,) of R runs, or numbers, the same for all or of one run.

    Those that a run does not have are NaN.
    """

    sticks: Any
    """Whether the plates can lock."""
    slip_rpm: Any
    """Slip at the end in rpm."""
    within_s: Any
    """Time in s at the end for which the slip of a linear clutch is below the threshold."""
    lock_s: Any
    """Time in s of the final lock after control start."""
    locked_s: Any
    """Time in s from then to the end."""
    releases: Any
    """Number of releases after control start."""
    tie_up_work: Any
    """Tie-up work in J of a gear shift."""
    flare: Any
    """Rise of w_m in rad/s between the gears of a shift."""
    withheld_s: Any
    added_s: Any
    delivered_share: Any

    @classmethod
    def of(cls, engagement: Engagement, rules: Rules) -> 'Decisive':
        """Return these of an engagement."""
        slip, lockup, shift = (
            engagement.trajectory.slip_speed,
            engagement.whole_lockup,
            engagement.shift,
        )
        outside = np.abs(slip[..., ::-1]) > rules.engaged_slip_rad_s
        samples = slip.shape[-1]
        within = np.where(outside.any(axis=-1), np.argmax(outside, axis=-1), samples)
        command = EngineCommand.of(engagement, rules) or EngineCommand(
            math.nan, math.nan, math.nan
        )
        return cls(
            engagement.sticks,
            rpm_from_rad_s(slip[..., -1]),
            (within - 1) * PERIOD_S,
            lockup.final_lock_s,
            engagement.periods * PERIOD_S - lockup.final_lock_s,
            0 if lockup.releases is None else lockup.releases,
            math.nan if shift is None or shift.tie_up_work is None else shift.tie_up_work,
            math.nan if shift is None or shift.flare is None else shift.flare,
            *command,
        )


def _state(run: Decisive, engine_end: str | None, rules: Rules) -> State:
    if run.tie_up_work > rules.tie_up_work_j:
        return State(
            TIED_UP,
            f'the clutches do {run.tie_up_work:.0f} J against each other, more than '
            f'{rules.tie_up_work_j:g} J',
        )
    if engine_end:
        return State(engine_end)
    return (
        _not_engaged(run, rules)
        or _flare(run, rules)
        or _late(run, rules)
        or _engine_command(run, rules)
        or State(ENGAGED)
    )


def _flare(run: Decisive, rules: Rules) -> State | None:
    if not run.flare > rules.flare_rad_s:
        return None
    return State(
        FLARED,
        f'the engine rises by {run.flare:.1f} rad/s between the gears, more than '
        f'{rules.flare_rad_s:g} rad/s',
    )


def _not_engaged(run: Decisive, rules: Rules) -> State | None:
    if run.sticks:
        if not math.isnan(run.lock_s):
            return None
        after = f' after {run.releases} release{"s" * (run.releases > 1)}' if run.releases else ''
        return State(
            NOT_ENGAGED,
            f'the plates are not locked at the end: slip {run.slip_rpm:.1f} rpm{after}',
        )
    if run.within_s >= rules.settled_time - _ROUNDING_S:
        return None
    return State(
        NOT_ENGAGED,
        f'the slip, {run.slip_rpm:.1f} rpm at the end, is not within '
        f'{rules.engaged_slip:g} rpm over the last {rules.settled_time:g} s',
    )


def _late(run: Decisive, rules: Rules) -> State | None:
    # A linear clutch has no lock, and plates that never part have it at 0.
    if not run.lock_s > 0.0 or run.locked_s >= rules.locked_time - _ROUNDING_S:
        return None
    return State(
        LATE,
        f'the plates are locked for the last {run.locked_s:.2f} s, less than '
        f'{rules.locked_time:g} s',
    )


def _engine_command(run: Decisive, rules: Rules) -> State | None:
    """Return WITHHELD or ADDED for a controller that commands the engine beyond the rules."""
    if run.withheld_s > rules.withheld_time:
        return State(
            WITHHELD,
            f'the controller takes {run.withheld_s:.2f} s of the largest demand away, more '
            f'than {rules.withheld_time:g} s',
        )
    if run.delivered_share < rules.delivered_share:
        return State(
            WITHHELD,
            f'the controller requests {100.0 * run.delivered_share:.0f} % of the demand over '
            f'the last {rules.delivered_time:g} s, less than {100.0 * rules.delivered_share:g} %',
        )
    if run.added_s > rules.added_time:
        return State(
            ADDED,
            f'the controller adds {run.added_s:.2f} s of the largest demand, more than '
            f'{rules.added_time:g} s',
        )
    return None


class EngineCommand(NamedTuple):
    """
    What a controller that commands the engine does with the demand of the driver, (...) each.

    NaN where there is no positive demand that it could take away.
    """

    withheld_s: Values
    """Integral of max(C_dem - C_cut - max(C_req, C_m), 0) over max C_dem, s."""
    added_s: Values
    """Integral of max(min(C_m, C_req) - C_dem, 0) over max C_dem, s."""
    delivered_share: Values
    """Share of the demand that is requested or given over the last `delivered_time`."""

    @classmethod
    def of(cls, engagement: Engagement, rules: Rules) -> 'EngineCommand | None':
        """
        Return these; None where the controller does not command the engine.

        C_req is its request, and C_m what the engine gives: it does not withhold what the torque
        cut C_cut of a handover takes, nor what idle control gives above its request, and by a
        negative request that the engine cannot follow no more than the demand.
        """
        run, start = engagement.trajectory, engagement.control_start
        if not run.two_input or engagement.periods < 1:
            return None
        demand, torque, request = (
            values[..., start:-1]
            for values in (run.torque_demand, run.engine_torque, run.engine_torque_request)
        )
        most = np.max(demand, axis=-1)
        most = np.where(most > 0.0, most, math.nan)
        last = round(rules.delivered_time / PERIOD_S)
        highest, lowest = np.maximum(request, torque), np.minimum(request, torque)
        wanted = demand if run.torque_cut is None else demand - run.torque_cut[..., start:-1]
        given = np.sum(np.minimum(highest, wanted)[..., -last:], axis=-1)
        at_end = np.sum(wanted[..., -last:], axis=-1)
        share = np.where(at_end > 0.0, given / np.where(at_end > 0.0, at_end, 1.0), 1.0)
        return cls(
            PERIOD_S * np.sum(np.maximum(wanted - highest, 0.0), axis=-1) / most,
            PERIOD_S * np.sum(np.maximum(lowest - demand, 0.0), axis=-1) / most,
            np.where(np.isnan(most), math.nan, share),
        )
