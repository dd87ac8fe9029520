# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The gears that are engaged in many runs."""

from collections.abc import Callable, Sequence

import numpy as np

from ddct_bringup.batch.stacks import stacked
from ddct_plant.friction.engagements import SHIFT_STATES, EngagedGears
from ddct_plant.models.driveline_model import STATES_AND_ANGLES


class Engaged:
    """
    Gears that are engaged in R runs of one kind, the counterpart of `EngagedGears`.

    Each of the values is one of the states times a factor, and the other way round.
    """

    def __init__(self, engaged: Sequence[EngagedGears]) -> None:
        """Take the engaged gears of each run."""
        one, names = engaged[0], SHIFT_STATES if engaged[0].clutches > 1 else STATES_AND_ANGLES
        size = len(one.integrator.system.a)
        self._of_state = _places_and_factors([each.to_values for each in engaged], size)
        self._of_value = _places_and_factors([each.of_values for each in engaged], len(names))
        self._gear, self._turning = stacked([each.gear for each in engaged]), one.turning

    def values(self, state: np.ndarray) -> np.ndarray:
        """Return the values for states (R, n): of STATES_AND_ANGLES, in a shift SHIFT_STATES."""
        places, factors = self._of_state
        values: np.ndarray = state[:, places] * factors
        return values

    def states(self, values: np.ndarray) -> np.ndarray:
        """Return the states (R, n) for the values."""
        places, factors = self._of_value
        states: np.ndarray = values[:, places] * factors
        return states

    def gear_speed(self, values: np.ndarray) -> np.ndarray:
        """Return the speeds in rad/s of the driveshafts' inner ends, (R,)."""
        speed: np.ndarray = self._gear.wheel_speed(values[:, self._turning])
        return speed


def _places_and_factors(
    functions: Sequence[Callable[[list[float]], list[float]]], size: int
) -> tuple[np.ndarray, np.ndarray]:
    """
    Return which of `size` numbers each result of some functions is, (m,), and the factors (R, m).

    The functions are those of R runs, which choose the same numbers.
    """
    first = functions[0](np.arange(1.0, size + 1.0).tolist())
    ones = np.array([function([1.0] * size) for function in functions])
    places = np.rint(np.array(first) / ones[0]).astype(int) - 1
    return places, ones
