"""
The state that a run reached: one word, by the rules of the limits file.

    engaged       the plates turn as one at the end, or never parted
    not_engaged   they do not, but nothing worse
    oscillating   the slip goes to and fro and has not settled
    runaway       the plates are driven apart
    stalled, over_revved   the engine left its limits, which ends the run
    invalid       the run does not count
"""

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.verdict.limits import Rules
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.models.engine_limits import OVER_REVVED, STALLED

ENGAGED, NOT_ENGAGED, OSCILLATING = 'engaged', 'not_engaged', 'oscillating'
RUNAWAY, INVALID = 'runaway', 'invalid'
STATES = (ENGAGED, NOT_ENGAGED, OSCILLATING, RUNAWAY, STALLED, OVER_REVVED, INVALID)


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
    cycle = _cycle(slip, rules)
    # A cycle leaves the band again before the longer half of it is over.
    needed = max(rules.settled_time, cycle or 0.0)
    if _time_within(slip, rules.engaged_slip) >= needed:
        return ENGAGED
    if _driven_apart(trajectory, slip, cycle is not None, rules):
        return RUNAWAY
    return NOT_ENGAGED if cycle is None else OSCILLATING


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


def _cycle(slip: np.ndarray, rules: Rules) -> float | None:
    """
    Return the longer half in s of the last cycle of a slip that goes to and fro, else None.

    It does when it has turned often enough, and last no longer ago than twice that.
    """
    turns = turns_of(slip, 2.0 * rules.engaged_slip)
    if len(turns) < rules.oscillation_turns:
        return None
    first, second, third = turns[-3:]
    longer_half = max(second - first, third - second)
    if len(slip) - 1 - third > 2 * longer_half:
        return None
    return longer_half * PERIOD_S


def _time_within(slip: np.ndarray, band: float) -> float:
    """Return for how many s the slip has kept within the band at the end."""
    outside = np.flatnonzero(np.abs(slip) > band)
    first = outside[-1] + 1 if outside.size else 0
    return float((len(slip) - 1 - first) * PERIOD_S)


def _driven_apart(trajectory: Trajectory, slip: np.ndarray, cycles: bool, rules: Rules) -> bool:
    """
    Say whether the slip grows at the end although the reference asks for none.

    Of a slip that goes to and fro it must also be beyond all that was before. Of one that has
    crossed zero the growth must not become less, as it does in an overshoot.
    """
    window = round(rules.settled_time / PERIOD_S)
    distance = np.abs(slip)
    asked = abs(rpm_from_rad_s(trajectory.slip_reference[-1, 0]))
    if len(slip) <= window or distance[-1] <= rules.engaged_slip or asked > rules.engaged_slip:
        return False
    growth = _growth(distance[-1 - window :])
    if growth < rules.runaway_growth:
        return False
    if cycles:
        before = np.max(distance[: -1 - window], initial=0.0)
        return bool(distance[-1] > before + rules.engaged_slip)
    other_side = np.flatnonzero(slip * slip[-1] < 0.0)
    if not other_side.size:
        return True
    beyond = distance[other_side[-1] + 1 :]
    if len(beyond) <= 2 * window:
        return False
    return growth > _growth(beyond[-1 - 2 * window : -window]) - rules.runaway_growth


def _growth(values: np.ndarray) -> float:
    """Return the slope per s of the straight line through samples of 10 ms."""
    return float(np.polyfit(np.arange(len(values)) * PERIOD_S, values, 1)[0])
