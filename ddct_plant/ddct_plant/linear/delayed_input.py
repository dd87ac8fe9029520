# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""An input behind a delay, in a system that is sampled with held inputs."""

import numpy as np

from ddct_plant.base.timebase import PERIOD_S, SUBSTEP_S, SUBSTEPS
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.sampling import discretise_zoh


def acting_inputs(system: StateSpace, late: int, column: int = 0) -> np.ndarray:
    """
    Return the effect on the states of the values of an input within 10 ms, (n, 1 or 2).

    `late` is the part of the delay in ms, 0 to 9, beyond whole periods. Then the earlier of two
    values acts for so long, and the later one for the rest: with Phi and Gamma of the first
    `late` ms (1) and of the rest (2), the columns are Phi_2 Gamma_1 and Gamma_2.
    """
    if not late:
        return discretise_zoh(system, PERIOD_S).b[:, column : column + 1]
    first = discretise_zoh(system, late * SUBSTEP_S)
    rest = discretise_zoh(system, (SUBSTEPS - late) * SUBSTEP_S)
    return np.column_stack([rest.a @ first.b[:, column], rest.b[:, column]])


def with_waiting_inputs(
    a: np.ndarray, acting: np.ndarray, periods: int, *, at_least: int = 0
) -> tuple[np.ndarray, np.ndarray]:
    """
    Return a (n + w, n + w) and b (n + w, 1) of a sampled system whose input is delayed.

    `acting` are its `acting_inputs`, `periods` the whole periods of the delay. The last states are
    the w values that have not acted in full, the latest at the end; with `at_least` there are so
    many, also those that have acted.
    """
    states, delayed = len(a), periods + acting.shape[1] - 1
    waiting = max(delayed, at_least)
    size = states + waiting
    of_states, b = np.zeros((size, size)), np.zeros((size, 1))
    of_states[:states, :states] = a
    for place, effect in enumerate(acting.T):
        if place < delayed:
            of_states[:states, states + waiting - delayed + place] = effect
        else:
            b[:states, 0] = effect
    if waiting:
        of_states[states:-1, states + 1 :] = np.eye(waiting - 1)
        b[-1] = 1.0
    return of_states, b
