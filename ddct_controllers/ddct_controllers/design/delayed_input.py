# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Exact sampling of a continuous system behind a zero-order hold and a delay of its input."""

import numpy as np

from ddct_controllers.design.state_space import series
from ddct_plant.base.timebase import PERIOD_S, SUBSTEPS
from ddct_plant.linear.delayed_input import acting_inputs
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.sampling import discretise_zoh


def sampled_behind_delay(system: StateSpace, substeps: int) -> StateSpace:
    """
    Return a continuous system, sampled at 10 ms, behind a hold and a delay of `substeps` ms.

    A delay of 13 ms is a whole period, and within each period the earlier of two inputs acts for
    3 ms and the later one for 7 ms, as in `ddct_plant.models.actuator`. The states are the inputs
    that have not acted in full yet, the latest first, then those of the system.
    """
    periods, late = divmod(substeps, SUBSTEPS)
    held = _changed_within_period(system, late) if late else discretise_zoh(system, PERIOD_S)
    return series(delay_line(periods), held) if periods else held


def delay_line(periods: int) -> StateSpace:
    """Return the delay of a sampled input by so many periods, which are its states."""
    inputs = np.eye(periods)
    shift = np.eye(periods, k=-1)
    return StateSpace(shift, inputs[:, :1], inputs[-1:], np.zeros((1, 1)), PERIOD_S)


def _changed_within_period(system: StateSpace, late: int) -> StateSpace:
    """
    Return the system whose input changes `late` ms after each sample, y_k = c x_k + d u'.

    u' is the earlier input, the first state.
    """
    acting, sampled = acting_inputs(system, late), discretise_zoh(system, PERIOD_S)
    none = np.zeros((1, 1 + len(system.a)))
    return StateSpace(
        np.vstack([none, np.hstack([acting[:, :1], sampled.a])]),
        np.vstack([np.ones((1, 1)), acting[:, 1:]]),
        np.hstack([system.d, system.c]),
        np.zeros((1, 1)),
        PERIOD_S,
    )
