# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Oscillations of the slip: turns, swings forced by a change of the drive, and the last cycle."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.verdict.rules import Rules
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rpm_from_rad_s

FEWEST_SWINGS = 4
"""Fewest swings, two cycles, that show a self-sustained oscillation and the drift of its mean."""


def turns_of(values: np.ndarray, swing: float) -> list[int]:
    """Return the indices of the turns of (n,) values: extremes followed by a return of `swing`."""
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

    A forced swing is the response to a change of the drive and starts another engagement, so the
    swings before and after it are not one oscillation. But where two cycles of free swings
    continue, a change of the drive ends none of them. Where the plant or the demand is unknown no
    swing is forced.
    """
    slip = rpm_from_rad_s(trajectory.slip_speed[control_start:])
    turns = turns_of(slip, 2.0 * rules.engaged_slip)
    if plant is None or trajectory.torque_demand is None or len(turns) < 2:
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
    Return dw_d/dt in rpm/s, (N+1,), caused by demand and load without any clutch torque.

    It is C_m/J_m + C_load/(tau J_eq), with C_m the driver's demand: the delivered torque may be a
    response to the slip.
    """
    imposed = trajectory.torque_demand / plant.engine_inertia
    if trajectory.load_torque is not None:
        imposed = imposed + trajectory.load_torque / plant.gear.across(plant.rest_inertia)
    return rpm_from_rad_s(imposed)


def _forced(slip: np.ndarray, imposed: np.ndarray, rest: float) -> bool:
    """
    Return whether the change of the drive alone could explain half of a swing in any direction.

    The samples are those from one turn to the next. A slip that stays within `rest` of the turn
    has not started to move; the drive may change in this time, and accelerates the plates
    afterwards. The change is counted from any instant of this time. Its direction does not count:
    the engine follows the demand at once, and the open loop of the clutch acts in the other
    direction later.
    """
    leaves = int(np.flatnonzero(np.abs(slip - slip[0]) <= rest)[-1])
    moving_s = (len(slip) - 1 - leaves) * PERIOD_S
    # The imposed acceleration is constant (zero-order hold) over the period after its sample.
    changes = np.sum(imposed[leaves:-1]) * PERIOD_S - imposed[: leaves + 1] * moving_s
    return bool(np.max(np.abs(changes)) >= abs(slip[-1] - slip[0]) / 2.0)


def cycle_of(slip: np.ndarray, turns: Sequence[int], rules: Rules) -> float | None:
    """
    Return the longest half in s of the last two cycles of an oscillating slip, else None.

    The slip oscillates when it has turned often enough and still moves. It has decayed when it has
    not turned for one longest half, has since moved less than half as far as in the swing before,
    and has moved by less than a turn within the last such half; or when it has not turned for
    twice that time. The interval between the first turns may be the engagement itself and is no
    half cycle. A bump splits a cycle in two, so the longest half is taken.
    """
    if len(turns) < rules.oscillation_turns:
        return None
    longest_half = int(max(np.diff(turns[1:])[-4:]))
    since = len(slip) - 1 - turns[-1]
    swing, moved = abs(slip[turns[-1]] - slip[turns[-2]]), np.ptp(slip[turns[-1] :])
    # Plates may stay locked a little longer than before, and then release into the next swing.
    moving = np.ptp(slip[-longest_half - 1 :]) >= 2.0 * rules.engaged_slip
    if since > (2 if moved >= swing / 2.0 or moving else 1) * longest_half:
        return None
    return longest_half * PERIOD_S
