# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Engines of many runs, which follow the driver's demand."""

from collections.abc import Sequence

import numpy as np

from ddct_bringup.batch.stacks import distinct
from ddct_plant.base.timebase import STEPS_PER_S
from ddct_plant.scenario.scenario import Scenario


class Engines:
    """Engines of R runs, the counterpart of `Engine` without requests of a controller."""

    def __init__(self, scenarios: Sequence[Scenario], steps: int) -> None:
        """Extend the demands to step `steps`."""
        times = np.arange(steps + 1) / STEPS_PER_S
        demands = [scenario.demand for scenario in scenarios]
        first, places = distinct(demands)
        profiles = [demands[index].over(times) for index in first]
        self._demands = np.stack([profiles[place] for place in places], axis=-1)

    def demand(self, step: int) -> np.ndarray:
        """Return the driver's demands of C_m in N m, (R,), at step `step`."""
        demand: np.ndarray = self._demands[step]
        return demand

    def torque(self, demand: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """Return C_m in N m over a period, (R,), for the demand at w_m in rad/s, (R,) each."""
        return demand
