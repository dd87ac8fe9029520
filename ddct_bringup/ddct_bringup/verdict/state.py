# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
State at the end of a run, by the rules of the limits file.

    engaged          the plates turn together at the end, or never separated
    nearly_engaged   a stick-slip clutch hardly slips at the end, but is not locked
    not_engaged      the plates still slip at the end, without oscillation or runaway
    oscillating      the slip oscillates and has not settled
    runaway          the plates are driven apart
    stalled, over_revved   the engine left its limits, which ends the run
    tied_up, flared  the handover of a gear shift went wrong (`shift_state.py`)
    invalid          the run does not count

The first two are successes, of first and of second rank; all others are failures.
"""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.metrics.zero_slip import LOCKED
from ddct_bringup.verdict.rules import Rules
from ddct_bringup.verdict.swings import FEWEST_SWINGS, cycle_of, free_turns
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.models.engine_limits import OVER_REVVED, STALLED

ENGAGED, NEARLY_ENGAGED, NOT_ENGAGED = 'engaged', 'nearly_engaged', 'not_engaged'
OSCILLATING, RUNAWAY, INVALID = 'oscillating', 'runaway', 'invalid'
TIED_UP, FLARED = 'tied_up', 'flared'
SUCCESSES = (ENGAGED, NEARLY_ENGAGED)
"""States of a successful engagement, the best first."""
STATES = (
    *SUCCESSES,
    NOT_ENGAGED,
    OSCILLATING,
    RUNAWAY,
    STALLED,
    OVER_REVVED,
    TIED_UP,
    FLARED,
    INVALID,
)
DOUBT = 2.0
"""Half-width of the 95 % confidence interval of a slope, in standard errors."""


def slip_state(
    trajectory: Trajectory, control_start: int, rules: Rules, plant: JudgedPlant | None = None
) -> str:
    """
    Return the state of a valid run whose engine stayed within its limits.

    `control_start` is the step at which feedback starts. Only later samples count, except for
    RUNAWAY by the magnitude of the slip. Without a plant no swing counts as forced, and the engine
    has no rev limiter.
    """
    whole = rpm_from_rad_s(trajectory.slip_speed)
    if np.max(np.abs(whole)) > rules.runaway_slip:
        return RUNAWAY
    slip = whole[control_start:]
    turns = free_turns(trajectory, control_start, rules, plant)
    cycle = cycle_of(slip, turns, rules)
    if success := _success(trajectory.clutch_phase, slip, cycle, rules):
        return success
    reference = abs(rpm_from_rad_s(trajectory.at_tick('slip_reference')[-1]))
    apart = _driven_apart(slip, rules) if cycle is None else _swings_apart(slip, turns, rules)
    if plant is not None:
        fastest = trajectory.engine_speed[-1 - _window(rules) :].max()
        apart = apart or (fastest >= plant.cut_speed and _stays_grown(slip, rules))
    if apart and reference <= rules.engaged_slip:
        return RUNAWAY
    return NOT_ENGAGED if cycle is None else OSCILLATING


def _success(
    phase: np.ndarray | None, slip: np.ndarray, cycle: float | None, rules: Rules
) -> str | None:
    """
    Return ENGAGED or NEARLY_ENGAGED where the plates are engaged at the end, else None.

    A stick-slip clutch is engaged as soon as it is locked, and nearly engaged when its slip stays
    as close to zero as in a lock. A linear clutch cannot lock: its slip passes through zero, where
    stick-slip plates would stay locked, and may return from the other side.
    """
    if phase is None:
        settled = _keeps_within(rules.engaged_slip, rules.settled_time, slip, cycle)
        return ENGAGED if settled or (cycle is None and _comes_back(slip, rules)) else None
    locked = phase[-1] == LOCKED
    least_s = 0.0 if locked else rules.settled_time
    if not _keeps_within(rules.locked_slip, least_s, slip, cycle):
        return None
    return ENGAGED if locked else NEARLY_ENGAGED


def _keeps_within(band: float, least_s: float, slip: np.ndarray, cycle: float | None) -> bool:
    """Return whether the slip stays within a band at the end, `least_s` and half a cycle long."""
    # An oscillation leaves the band again within its longest half cycle.
    return _time_within(slip, band) >= max(least_s, cycle or 0.0)


def _time_within(slip: np.ndarray, band: float) -> float:
    """Return the time in s for which the slip has stayed within the band at the end."""
    outside = np.flatnonzero(np.abs(slip) > band)
    first = outside[-1] + 1 if outside.size else 0
    return float((len(slip) - 1 - first) * PERIOD_S)


def _comes_back(slip: np.ndarray, rules: Rules) -> bool:
    """
    Return whether a slip that has crossed zero is about to return to zero.

    Its magnitude after the crossing is smaller than before, and at the rate of decrease at the end
    it reaches zero in less time than has passed since the crossing.
    """
    window, crossed = _window(rules), _crossing(slip)
    distance = np.abs(slip)
    beyond = distance[crossed:]
    if not crossed or len(beyond) <= window or beyond.max() >= distance[:crossed].max():
        return False
    fall = -_growth(beyond[-1 - window :])
    return bool(beyond[-1] < fall * (len(beyond) - 1) * PERIOD_S)


def _driven_apart(slip: np.ndarray, rules: Rules) -> bool:
    """
    Return whether the slip grows at the end.

    Where the slip has crossed zero and its magnitude is not larger than before the crossing, its
    growth rate must not decrease, as it does in an overshoot.
    """
    window = _window(rules)
    distance = np.abs(slip)
    if len(slip) <= window or distance[-1] <= rules.engaged_slip:
        return False
    growth = _growth(distance[-1 - window :])
    if growth < rules.runaway_growth:
        return False
    crossed = _crossing(slip)
    if distance[-1] > distance[:crossed].max(initial=0.0):
        return True
    beyond = distance[crossed:]
    if len(beyond) <= 2 * window:
        return False
    return growth > _growth(beyond[-1 - 2 * window : -window]) - rules.runaway_growth


def _stays_grown(slip: np.ndarray, rules: Rules) -> bool:
    """
    Return whether the slip stays above its first value and above the band at the end.

    Where the rev limiter limits the engine speed such a slip no longer grows: only the ripple of
    the limiter is left.
    """
    return bool(slip[-1 - _window(rules) :].min() > max(slip[0], rules.engaged_slip))


def _swings_apart(slip: np.ndarray, turns: Sequence[int], rules: Rules) -> bool:
    """
    Return whether an oscillating slip drifts away from zero, or its amplitude grows.

    It drifts when it does not reach the band around zero in the last cycle, and the slope of a
    straight line through the midpoints of the later half of the swings exceeds `runaway_growth` by
    its uncertainty. The amplitude grows when the last cycle reaches `runaway_swing` times the
    earlier maximum.
    """
    before, cycle = slip[: turns[-3] + 1], slip[turns[-3] + 1 :]
    if np.abs(cycle).max() >= rules.runaway_swing * np.abs(before).max():
        return True
    at = np.asarray(turns)
    middles = ((slip[at[1:]] + slip[at[:-1]]) / 2.0)[(len(at) - 1) // 2 :]
    times = ((at[1:] + at[:-1]) * PERIOD_S / 2.0)[(len(at) - 1) // 2 :]
    if len(middles) < FEWEST_SWINGS or _reaches(cycle, rules.engaged_slip):
        return False
    (slope, _), spread = np.polyfit(times, np.sign(middles[-1]) * middles, 1, cov=True)
    return bool(slope - DOUBT * np.sqrt(spread[0, 0]) >= rules.runaway_growth)


def _reaches(slip: np.ndarray, band: float) -> bool:
    return bool(slip.min() <= band and slip.max() >= -band)


def _window(rules: Rules) -> int:
    return round(rules.settled_time / PERIOD_S)


def _crossing(slip: np.ndarray) -> int:
    """Return the first sample after the last change of sign of the slip, 0 without one."""
    other_side = np.flatnonzero(slip * slip[-1:] < 0.0)
    return int(other_side[-1]) + 1 if other_side.size else 0


def _growth(values: np.ndarray) -> float:
    """Return the slope per s of a straight line fitted to samples at 10 ms."""
    return float(np.polyfit(np.arange(len(values)) * PERIOD_S, values, 1)[0])
