"""How the slip goes to and fro: its turns, which swings the drive forces, and its last cycle."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.verdict.limits import Rules
from ddct_bringup.verdict.plant import JudgedPlant
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rpm_from_rad_s

FEWEST_SWINGS = 4
"""Two cycles: the fewest that show a slip to swing by itself, and where its middle goes."""


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


def free_turns(
    trajectory: Trajectory, control_start: int, rules: Rules, plant: JudgedPlant | None
) -> list[int]:
    """
    Return the turns of the slip after control start, from the end of the last forced swing on.

    A forced swing is the answer to another drive and begins another engagement, so what was before
    it and what comes after are not one oscillation; but where two cycles of free swings go on, a
    change of the drive ends none of them. Where the plant or the demand is not known no swing is
    forced.
    """
    slip = rpm_from_rad_s(trajectory.slip_speed[control_start:])
    turns = turns_of(slip, 2.0 * rules.engaged_slip)
    if plant is None or trajectory.torque_demand is None:
        return turns
    imposed = _imposed_acceleration(trajectory, plant)[control_start:]
    begin = 0
    for place in range(1, len(turns)):
        first, last = turns[place - 1], turns[place] + 1
        goes_on = place - begin > FEWEST_SWINGS and cycle_of(
            slip[: first + 1], turns[begin:place], rules
        )
        if not goes_on and _forced(slip[first:last], imposed[first:last], rules.locked_slip):
            begin = place
    return turns[begin:]


def _imposed_acceleration(trajectory: Trajectory, plant: JudgedPlant) -> np.ndarray:
    """
    Return dw_d/dt in rpm/s, (N+1,), that demand and load give plates which transmit no torque.

    It is C_m/J_m + C_load/(tau J_eq), with C_m the driver's demand: what the engine delivers may
    answer the slip.
    """
    imposed = trajectory.torque_demand / plant.engine_inertia
    if trajectory.load_torque is not None:
        imposed = imposed + trajectory.load_torque / (plant.total_ratio * plant.rest_inertia)
    return rpm_from_rad_s(imposed)


def _forced(slip: np.ndarray, imposed: np.ndarray, rest: float) -> bool:
    """
    Say whether the change of the drive could alone explain half of a swing, in either direction.

    The samples are those from one turn to the next. A slip that stays within `rest` of the turn
    has not begun to move; the drive may change in this time, and moves the plates from then on.
    The change is that since any instant of the rest. Its direction does not count: the engine
    follows the demand at once, and the open loop of the clutch pushes the other way later.
    """
    leaves = int(np.flatnonzero(np.abs(slip - slip[0]) <= rest)[-1])
    moving_s = (len(slip) - 1 - leaves) * PERIOD_S
    # What is imposed is held over the period after its sample.
    changes = np.sum(imposed[leaves:-1]) * PERIOD_S - imposed[: leaves + 1] * moving_s
    return bool(np.max(np.abs(changes)) >= abs(slip[-1] - slip[0]) / 2.0)


def cycle_of(slip: np.ndarray, turns: Sequence[int], rules: Rules) -> float | None:
    """
    Return the longest half in s of the last two cycles of a slip that goes to and fro, else None.

    It does when it has turned often enough and goes on. It has died down when it has not turned
    for that long, has since moved less than half as far as in the swing before, and has moved by
    less than a turn within the last such half; or when it has not turned for twice that long. What
    lies between its first turns may be the engagement itself and is no half of a cycle; a bump
    halves a cycle, so one alone does not tell.
    """
    if len(turns) < rules.oscillation_turns:
        return None
    longest_half = int(max(np.diff(turns[1:])[-4:]))
    since = len(slip) - 1 - turns[-1]
    swing, moved = abs(slip[turns[-1]] - slip[turns[-2]]), np.ptp(slip[turns[-1] :])
    # Plates may stay locked a little longer than before, and then leave for the next swing.
    moving = np.ptp(slip[-longest_half - 1 :]) >= 2.0 * rules.engaged_slip
    if since > (2 if moved >= swing / 2.0 or moving else 1) * longest_half:
        return None
    return longest_half * PERIOD_S
