# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A plain numpy loop: the fewest operations of a simulation, for the cost of a step beside it."""

import time

import numpy as np

STATES, INPUTS = 13, 3
"""States and inputs of the loop: those of driveline, actuator, delay and PI in one system."""
STEPS = 300
"""Steps of a run of the scenario `thesis`."""
NAME = 'a plain numpy loop'
LEAST_S = 0.05
"""Least duration of one measurement, s, so that the clock does not limit it."""


def numpy_loop_s(runs: int = 1) -> float:
    """
    Return the processor time per step in s of x_{k+1} = A x_k + B u_k in plain numpy.

    `runs` states are the columns of x; the states of every step are stored.
    """
    random = np.random.default_rng(3)
    a = random.standard_normal((STATES, STATES))
    a *= 0.9 / np.abs(np.linalg.eigvals(a)).max()
    b = random.standard_normal((STATES, INPUTS))
    u = random.standard_normal((STEPS, INPUTS, runs))
    stored = np.zeros((STEPS + 1, STATES, runs))
    started, steps = time.thread_time(), 0
    while (elapsed := time.thread_time() - started) < LEAST_S:
        for k in range(STEPS):
            stored[k + 1] = a @ stored[k] + b @ u[k]
        steps += STEPS
    return elapsed / steps
