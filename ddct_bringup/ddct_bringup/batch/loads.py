# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Road loads of many cars."""

from collections.abc import Sequence

import numpy as np

from ddct_plant.base.timebase import STEPS_PER_S
from ddct_plant.models.load import RoadLoad, resisting_torque


class Loads:
    """Road loads of R cars, the counterpart of `RoadLoad`."""

    def __init__(self, loads: Sequence[RoadLoad], steps: int) -> None:
        """Extend the profiles of the roads to step `steps`."""
        self.wheel_radius = np.array([load.wheel_radius for load in loads])
        """Wheel radii r_w in m, (R,)."""
        self._drag = np.array([load.drag for load in loads])
        self._wind = np.array([load.wind for load in loads])
        times = np.arange(steps + 1) / STEPS_PER_S
        self._forces = np.stack([load.forces(times) for load in loads], axis=-1)

    def torque(self, step: int, vehicle_speed: np.ndarray) -> np.ndarray:
        """Return C_load in N m, (R,), at step `step` at speeds in m/s, (R,)."""
        torque: np.ndarray = resisting_torque(
            self._drag, self._wind, self._forces[step], self.wheel_radius, vehicle_speed
        )
        return torque
