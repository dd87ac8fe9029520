# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Programs of an engagement over a horizon: the least squared moves with weighted ends."""

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from ddct_controllers.mpc.model.transmission_model import (
    ENGINE_TORQUE,
    LOAD_TORQUE,
    REQUEST,
    SLIP_SPEED,
    TransmissionModel,
)
from ddct_controllers.mpc.qp.problem import QpStructure
from ddct_plant.base.timebase import PERIOD_S

MOVES = 10
"""Number of moves, spread evenly over the horizon, with a constant request between them."""
SLIP_WEIGHT = 100.0
"""Weight of the slip at the end, in N m per rad/s: 0.1 rad/s costs as much as 10 N m."""
ACCELERATION_WEIGHT = 5.0
"""Weight of dw_d/dt at the end, in N m per rad/s^2: 2 rad/s^2 cost as much as 10 N m."""


@dataclass(frozen=True, eq=False)
class EngagementProgram:
    """
    Minimise the squared moves of the request plus the squared weighted deviations at the end.

    The deviations are those of the slip from the desired one and of its rate over the last period
    from zero. With v = (state, request before, C_m, C_load, desired slip), f = gradient @ v; the
    constrained rows are the request's levels less the request before.
    """

    gradient: np.ndarray
    """Map from v to the linear cost f, (MOVES, states + 4)."""
    structure: QpStructure

    @cached_property
    def without_rows(self) -> np.ndarray:
        """Map from v to the first move and the levels that are limited, without limits."""
        first, levels = self.structure.without_rows(self.gradient)
        levels[:, -4] += 1.0  # the request before
        return np.vstack([first, levels])


@lru_cache  # runs with equal known settings share them
def engagement_programs(
    model: TransmissionModel, shortest: int, longest: int
) -> dict[int, EngagementProgram]:
    """Return the programs for horizons of `shortest` (MOVES or more) to `longest` periods."""
    c = model.c[SLIP_SPEED]
    states, held = np.eye(len(model.a)), np.zeros((len(model.a), 3))
    free, steps = [c @ states], [c @ held]
    for _ in range(longest):
        states, held = model.a @ states, model.a @ held + model.b
        free.append(c @ states)
        steps.append(c @ held)
    return {
        horizon: _program(np.array(free[: horizon + 1]), np.array(steps[: horizon + 1]))
        for horizon in range(shortest, longest + 1)
    }


def _program(free: np.ndarray, steps: np.ndarray) -> EngagementProgram:
    """
    Condense one horizon of p periods.

    `free` (p + 1, n) is the slip's response to the state at periods 0..p, `steps` (p + 1, 3) that
    to unit steps of the inputs from period 0 on.
    """
    horizon = len(steps) - 1
    starts = [move * horizon // MOVES for move in range(MOVES)]
    ends = np.array([[0.0, SLIP_WEIGHT], [-1.0, 1.0]])
    ends[1] *= ACCELERATION_WEIGHT / PERIOD_S
    # At the last two periods, to a step that begins at each start.
    delayed = [steps[horizon - 1 - start : horizon + 1 - start, REQUEST] for start in starts]
    response = ends @ np.transpose(delayed)
    inputs = steps[-2:, [REQUEST, ENGINE_TORQUE, LOAD_TORQUE]]
    known = np.hstack([ends @ free[-2:], ends @ inputs, [[-SLIP_WEIGHT], [0.0]]])
    levels = np.tril(np.ones((MOVES, MOVES)))
    structure = QpStructure(np.eye(MOVES) + response.T @ response, levels)
    return EngagementProgram(response.T @ known, structure)
