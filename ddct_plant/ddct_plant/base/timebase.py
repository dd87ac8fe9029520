# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The one time base of every run: integer nanoseconds, 10 ms periods, 1 ms sub-intervals.

Step k is stamped t_k = t_0 + k x 10 ms with t_0 = 1 s exactly, because a ROS time of zero means
"no clock". Scenario time is the stamp less t_0.
"""

from functools import lru_cache

from ddct_plant.base.errors import DdctError, ParameterError

START_NS = 1_000_000_000
"""Stamp t_0 in ns."""
PERIOD_NS = 10_000_000
"""Period in ns."""
PERIOD_S = 0.01
"""Period in s."""
STEPS_PER_S = 100
"""Periods per second."""
LONGEST_S = 3600.0
"""Longest time in s of a scenario."""
SUBSTEPS = 10
"""Sub-intervals of one period over which the actuator torque is piecewise linear."""
SUBSTEP_NS = PERIOD_NS // SUBSTEPS
"""Length of a sub-interval in ns."""
SUBSTEP_S = 0.001
"""Length of a sub-interval in s."""


def stamp_of_step(step: int) -> int:
    """Return the stamp t_k in ns of step k."""
    return START_NS + step * PERIOD_NS


@lru_cache(maxsize=64)  # in one process some thirty messages carry each stamp
def step_of_stamp(stamp_ns: int) -> int:
    """Return k of the stamp t_k; raise DdctError for a stamp that is off the 10 ms grid."""
    step, rest = divmod(stamp_ns - START_NS, PERIOD_NS)
    if rest or step < 0:
        raise DdctError(
            f'stamp {stamp_ns} ns is not on the grid 1 s + k x 10 ms: '
            'stamp the message with the tick it answers'
        )
    return step


def time_of_step(step: int) -> float:
    """Return the scenario time in s of step k, correctly rounded."""
    return step / STEPS_PER_S


def steps_in(name: str, duration_s: float) -> int:
    """Return `duration_s` in periods; raise ParameterError unless it is a whole number of them."""
    steps = round(duration_s * STEPS_PER_S)
    if abs(duration_s * STEPS_PER_S - steps) > 1e-6:
        raise ParameterError(
            f'{name} is {duration_s:g} s: give a multiple of {PERIOD_S} s', key=name
        )
    return steps
