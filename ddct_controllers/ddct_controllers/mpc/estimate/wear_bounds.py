"""Bounds of the estimate of K_usura."""

import numpy as np

from ddct_controllers.mpc.estimate.wear_noise import GAIN

LOWEST_GAIN, HIGHEST_GAIN = 0.5, 1.5
"""Beyond the 0.7 to 1.3 that a clutch is taken to reach."""


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
