# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Step response of a closed loop; rise time and overshoot as the thesis measures them."""

import numpy as np

from ddct_controllers.design.analysis.loops import ContinuousLoop
from ddct_controllers.design.state_space import close_loop
from ddct_plant.base.errors import require_number
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.sampling import discretise_zoh

TIME_STEP_S = 0.001
"""Time in s between the points at which a continuous loop is evaluated, each of them exact."""
_BLOCK = 128
"""
Number of points computed at once.

python-control takes one after another, 10 to 80 times as long.
"""


def step_response(
    loop: ContinuousLoop | StateSpace, duration_s: float
) -> tuple[np.ndarray, np.ndarray]:
    """
    Return time in s and the output of L/(1 + L) for a unit step of the reference, both (n,).

    A sampled loop gives its samples, a continuous one a point per millisecond. Raise
    ParameterError for a continuous loop with delay.
    """
    require_number('duration_s', duration_s, above=0.0)
    system = loop.to_state_space() if isinstance(loop, ContinuousLoop) else loop
    period_s = system.period_s or TIME_STEP_S
    time = period_s * np.arange(round(duration_s / period_s) + 1)
    closed = close_loop(system)
    sampled = closed if closed.period_s else discretise_zoh(closed, period_s)
    return time, _output_of_step(sampled, len(time))


def _output_of_step(system: StateSpace, points: int) -> np.ndarray:
    """Return the (points,) output of a sampled system at rest whose input becomes 1 at 0."""
    order = len(system.a)
    # With the input as a further state, which stays 1, the system runs by itself.
    a = np.block([[system.a, system.b], [np.zeros(order), 1.0]])
    rows = [np.hstack([system.c[0], system.d[0]])]
    for _ in range(_BLOCK - 1):
        rows.append(rows[-1] @ a)
    over_block = np.linalg.matrix_power(a, _BLOCK)
    state = np.eye(order + 1)[-1]
    blocks = []
    for _ in range(0, points, _BLOCK):
        blocks.append(np.array(rows) @ state)
        state = over_block @ state
    return np.concatenate(blocks)[:points]


def rise_time_and_overshoot(
    loop: ContinuousLoop | StateSpace, duration_s: float
) -> tuple[float | None, float]:
    """Return rise time in s, None if it is never over, and overshoot as a fraction."""
    response = step_response(loop, duration_s)
    return rise_time_s(*response), overshoot(*response)


def rise_time_s(time: np.ndarray, output: np.ndarray) -> float | None:
    """
    Return the first time in s at which the output crosses 1, t_r of Section 2.1; None if never.

    Linear between points. The final value is that of a loop with an integrator, 1, not the last
    point: slow poles take minutes to settle.
    """
    above = np.flatnonzero(output >= 1.0)
    if not above.size or above[0] == 0:
        return float(time[0]) if above.size else None
    after = int(above[0])
    before = after - 1
    share = (1.0 - output[before]) / (output[after] - output[before])
    return float(time[before] + share * (time[after] - time[before]))


def overshoot(time: np.ndarray, output: np.ndarray) -> float:
    """Return the largest excess of the output over the final value 1, as a fraction."""
    return max(0.0, float(np.max(output)) - 1.0)
