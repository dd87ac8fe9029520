# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""State of the filter that estimates the wear gain, and the bounds of that gain."""

import numpy as np

from ddct_controllers.mpc.model.transmission_model import DRIVELINE_STATES
from ddct_plant.linear.names import Names

FILTER_STATES = DRIVELINE_STATES + Names(('wear_gain', 'clutch_error', 'load_error'))
"""States of the filter: the driveline's, K_usura, and the errors of C_f and C_load in N m."""
GAIN, CLUTCH_ERROR, LOAD_ERROR = FILTER_STATES.places('wear_gain', 'clutch_error', 'load_error')
SIZE = len(FILTER_STATES)
LOWEST_GAIN, HIGHEST_GAIN = 0.5, 1.5
"""Bounds of the estimate of K_usura; a clutch is assumed to reach 0.7 to 1.3."""


def within_bounds(state: np.ndarray, covariance: np.ndarray) -> np.ndarray:
    """
    Return the likeliest state (SIZE,) whose K_usura is within the bounds.

    What K_usura gives up goes to the states that `covariance` (SIZE, SIZE) ties to it, the error
    of C_f above all: the projection of Simon and Chia (IEEE Trans. Aerospace and Electronic
    Systems 38, 2002) with W = P^-1.
    """
    gain = state[GAIN]
    bound = min(max(gain, LOWEST_GAIN), HIGHEST_GAIN)
    if bound == gain:
        return state
    state = state + covariance[:, GAIN] / covariance[GAIN, GAIN] * (bound - gain)
    # Exactly, whatever is rounded.
    state[GAIN] = bound
    return state
