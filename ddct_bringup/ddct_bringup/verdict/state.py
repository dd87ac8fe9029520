"""
The state that a run reached: one word, by the rules of the limits file.

    engaged       the plates turn as one at the end, or never parted
    not_engaged   they do not, but nothing worse
    oscillating   the slip goes to and fro and has not settled
    runaway       the plates are driven apart
    stalled, over_revved   the engine left its limits, which ends the run
    invalid       the run does not count
"""

from typing import Any

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.verdict.limits import Rules
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rpm_from_rad_s

ENGAGED, NOT_ENGAGED, OSCILLATING = 'engaged', 'not_engaged', 'oscillating'
RUNAWAY, STALLED, OVER_REVVED, INVALID = 'runaway', 'stalled', 'over_revved', 'invalid'
STATES = (ENGAGED, NOT_ENGAGED, OSCILLATING, RUNAWAY, STALLED, OVER_REVVED, INVALID)


def engine_end(trajectory: Trajectory, engine_limits: Any) -> str | None:
    """
    Return STALLED or OVER_REVVED when the last engine speed is at or beyond that limit, else None.

    `engine_limits` is that section of the scenario, None without one.
    """
    if engine_limits is None:
        return None
    speed = trajectory.joint_speed[-1, 0]
    if speed <= engine_limits.stall_rad_s:
        return STALLED
    return OVER_REVVED if speed >= engine_limits.over_rev_rad_s else None


def slip_state(trajectory: Trajectory, control_start: int, rules: Rules) -> str:
    """
    Return the state of a run that counts, whose engine kept its limits.

    `control_start` is the step at which feedback starts. Only what comes after it counts, but for
    RUNAWAY by the magnitude of the slip.
    """
    whole = rpm_from_rad_s(trajectory.slip_speed)
    if np.max(np.abs(whole)) > rules.runaway_slip:
        return RUNAWAY
    slip = whole[control_start:]
    turns = turns_of(slip, 2.0 * rules.engaged_slip)
    oscillates = len(turns) >= rules.oscillation_turns
    needed = rules.settled_time
    if oscillates:
        # A cycle leaves the band again within half of its period.
        needed = max(needed, (turns[-1] - turns[-2]) * PERIOD_S)
    if _time_within(slip, rules.engaged_slip) >= needed:
        return ENGAGED
    if _driven_apart(trajectory, slip, oscillates, rules):
        return RUNAWAY
    return OSCILLATING if oscillates else NOT_ENGAGED


def turns_of(values: np.ndarray, swing: float) -> list[int]:
    """Return where the (n,) values turn: extremes from which they move back by `swing` or more."""
    turns: list[int] = []
    low = high = 0
    direction = 0
    for index, value in enumerate(values.tolist()):
        if value > values[high]:
            high = index
        if value < values[low]:
            low = index
        if direction >= 0 and values[high] - value >= swing:
            if direction > 0 or high > 0:
                turns.append(high)
            direction, low = -1, index
        elif direction <= 0 and value - values[low] >= swing:
            if direction < 0 or low > 0:
                turns.append(low)
            direction, high = 1, index
    return turns


def _time_within(slip: np.ndarray, band: float) -> float:
    """Return for how many s the slip has kept within the band at the end."""
    outside = np.flatnonzero(np.abs(slip) > band)
    first = outside[-1] + 1 if outside.size else 0
    return float((len(slip) - 1 - first) * PERIOD_S)


def _driven_apart(
    trajectory: Trajectory, slip: np.ndarray, oscillates: bool, rules: Rules
) -> bool:
    """
    Say whether the slip grows at the end although the reference asks for none.

    Of a slip that goes to and fro it must also be beyond all that was before.
    """
    window = round(rules.settled_time / PERIOD_S)
    distance = np.abs(slip)
    asked = abs(rpm_from_rad_s(trajectory.slip_reference[-1, 0]))
    if len(slip) <= window or distance[-1] <= rules.engaged_slip or asked > rules.engaged_slip:
        return False
    last = distance[-1 - window :]
    growth = np.polyfit(np.arange(window + 1) * PERIOD_S, last, 1)[0]
    if growth < rules.runaway_growth:
        return False
    before = np.max(distance[: -1 - window], initial=0.0)
    return not oscillates or bool(distance[-1] > before + rules.engaged_slip)
