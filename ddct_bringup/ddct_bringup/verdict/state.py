"""
The state that a run reached: one word, by the rules of the limits file.

    engaged       the plates turn as one at the end, or never parted
    not_engaged   they do not, but nothing worse
    oscillating   the slip goes to and fro and has not settled
    runaway       the plates are driven apart
    stalled, over_revved   the engine left its limits, which ends the run
    invalid       the run does not count
"""

import math
from collections.abc import Sequence

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.verdict.limits import Rules
from ddct_bringup.verdict.meeting import LOCKED
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.models.engine_limits import OVER_REVVED, STALLED

ENGAGED, NOT_ENGAGED, OSCILLATING = 'engaged', 'not_engaged', 'oscillating'
RUNAWAY, INVALID = 'runaway', 'invalid'
SUCCESSES = (ENGAGED,)
"""The states in which an engagement has not failed, the best first."""
STATES = (ENGAGED, NOT_ENGAGED, OSCILLATING, RUNAWAY, STALLED, OVER_REVVED, INVALID)
_ENGINE = 0
"""Its place among the joints."""
FEWEST_SWINGS = 4
"""Through whose middles a line says something: two cycles."""
DOUBT = 2.0
"""Standard errors of a slope: 95 % of what chance makes."""


def slip_state(
    trajectory: Trajectory, control_start: int, rules: Rules, cut_speed: float = math.inf
) -> str:
    """
    Return the state of a run that counts, whose engine kept its limits.

    `control_start` is the step at which feedback starts. Only what comes after it counts, but for
    RUNAWAY by the magnitude of the slip. `cut_speed` is that of the rev limiter in rad/s.
    """
    whole = rpm_from_rad_s(trajectory.slip_speed)
    if np.max(np.abs(whole)) > rules.runaway_slip:
        return RUNAWAY
    slip = whole[control_start:]
    turns = turns_of(slip, 2.0 * rules.engaged_slip)
    cycle = _cycle(slip, turns, rules)
    if _together(trajectory.clutch_phase, slip, cycle, rules):
        return ENGAGED
    asked = abs(rpm_from_rad_s(trajectory.slip_reference[-1, 0]))
    apart = _driven_apart(slip, rules) if cycle is None else _swings_apart(slip, turns, rules)
    at_limiter = trajectory.joint_speed[-1 - _window(rules) :, _ENGINE].max() >= cut_speed
    apart = apart or (at_limiter and _stays_grown(slip, rules))
    if apart and asked <= rules.engaged_slip:
        return RUNAWAY
    return NOT_ENGAGED if cycle is None else OSCILLATING


def turns_of(values: np.ndarray, swing: float) -> list[int]:
    """Return where the (n,) values turn: extremes from which they move back by `swing` or more."""
    turns: list[int] = []
    low = high = 0
    direction = 0
    numbers = values.tolist()
    for index, value in enumerate(numbers):
        if value > numbers[high]:
            high = index
        if value < numbers[low]:
            low = index
        if direction >= 0 and numbers[high] - value >= swing:
            if direction > 0 or high > 0:
                turns.append(high)
            direction, low = -1, index
        elif direction <= 0 and value - numbers[low] >= swing:
            if direction < 0 or low > 0:
                turns.append(low)
            direction, high = 1, index
    return turns


def _cycle(slip: np.ndarray, turns: Sequence[int], rules: Rules) -> float | None:
    """
    Return the longest half in s of the last two cycles of a slip that goes to and fro, else None.

    It does when it has turned often enough and goes on. It has died down when it has not turned
    for that long and since then moved less than half as far as in the swing before, or when it has
    not turned for twice that long. What lies between its first turns may be the engagement itself
    and is no half of a cycle; a bump halves a cycle, so one alone does not tell.
    """
    if len(turns) < rules.oscillation_turns:
        return None
    longest_half = max(np.diff(turns[1:])[-4:])
    since = len(slip) - 1 - turns[-1]
    swing, moved = abs(slip[turns[-1]] - slip[turns[-2]]), np.ptp(slip[turns[-1] :])
    if since > (2 if moved >= swing / 2.0 else 1) * longest_half:
        return None
    return float(longest_half * PERIOD_S)


def _together(
    phase: np.ndarray | None, slip: np.ndarray, cycle: float | None, rules: Rules
) -> bool:
    """
    Say whether the plates turn as one at the end.

    Those of a clutch that sticks do when they are locked, at once. A linear clutch cannot lock: it
    runs through zero, where such plates would stay, and its slip may come back from beyond.
    """
    locked = phase is not None and phase[-1] == LOCKED
    band = rules.engaged_slip if phase is None else rules.locked_slip
    # A cycle leaves the band again before the longest half of it is over.
    needed = max(0.0 if locked else rules.settled_time, cycle or 0.0)
    if _time_within(slip, band) >= needed:
        return True
    return phase is None and cycle is None and _comes_back(slip, rules)


def _time_within(slip: np.ndarray, band: float) -> float:
    """Return for how many s the slip has kept within the band at the end."""
    outside = np.flatnonzero(np.abs(slip) > band)
    first = outside[-1] + 1 if outside.size else 0
    return float((len(slip) - 1 - first) * PERIOD_S)


def _comes_back(slip: np.ndarray, rules: Rules) -> bool:
    """
    Say whether a slip that has crossed zero is about to return there.

    It has gone less far beyond than it was before, and at the rate at which it falls at the end it
    is gone in less time than it has been beyond.
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
    Say whether the slip grows at the end.

    Of one that has crossed zero, and has not gone further than it was before, the growth must not
    become less, as it does in an overshoot.
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
    Say whether the engine was faster than at first all the time at the end, and plates apart.

    Where the rev limiter holds the engine such a slip grows no more, and is only its ripple.
    """
    return bool(slip[-1 - _window(rules) :].min() > max(slip[0], rules.engaged_slip))


def _swings_apart(slip: np.ndarray, turns: Sequence[int], rules: Rules) -> bool:
    """
    Say whether a slip that goes to and fro moves away from zero, or swings ever further.

    The plates do not meet in the last cycle, and a straight line through the middles of the later
    half of the swings grows by more than its doubt. The slip swings ever further when its last
    cycle reaches `runaway_swing` times what was reached before.
    """
    before, cycle = slip[: turns[-3] + 1], slip[turns[-3] + 1 :]
    if np.abs(cycle).max() >= rules.runaway_swing * np.abs(before).max():
        return True
    at = np.asarray(turns)
    middles = ((slip[at[1:]] + slip[at[:-1]]) / 2.0)[(len(at) - 1) // 2 :]
    times = ((at[1:] + at[:-1]) * PERIOD_S / 2.0)[(len(at) - 1) // 2 :]
    if len(middles) < FEWEST_SWINGS or _met(cycle, rules.engaged_slip):
        return False
    (slope, _), spread = np.polyfit(times, np.sign(middles[-1]) * middles, 1, cov=True)
    return bool(slope - DOUBT * np.sqrt(spread[0, 0]) >= rules.runaway_growth)


def _met(slip: np.ndarray, band: float) -> bool:
    return bool(slip.min() <= band and slip.max() >= -band)


def _window(rules: Rules) -> int:
    return round(rules.settled_time / PERIOD_S)


def _crossing(slip: np.ndarray) -> int:
    """Return from which sample on the slip keeps the sign that it ends with, 0 for all."""
    other_side = np.flatnonzero(slip * slip[-1:] < 0.0)
    return int(other_side[-1]) + 1 if other_side.size else 0


def _growth(values: np.ndarray) -> float:
    """Return the slope per s of the straight line through samples of 10 ms."""
    return float(np.polyfit(np.arange(len(values)) * PERIOD_S, values, 1)[0])
