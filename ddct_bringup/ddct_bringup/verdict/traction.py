"""
What the driven axle can carry: beyond it the car's wheels would spin.

The plant's wheels roll without slip, so a run that drives harder is none of a car.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.verdict.plant import JudgedPlant

_DRIVESHAFT = 3
"""Its place among the joints."""


@dataclass(frozen=True)
class TractionRule:
    """What a limits file assumes of tyres and car; the reasons stand there."""

    friction: float
    """mu between tyre and road."""
    driven_share: float
    """Of the weight on the driven front axle at rest, 0 to 1."""
    height_over_wheelbase: float
    """h/L of the centre of gravity."""
    reason: str
    """Why these values, in a line for tables."""

    def limit(self, gravity: float) -> float:
        """
        Return the largest driving force over the mass in m/s^2: mu g s / (1 + mu h/L).

        Acceleration a takes m a h/L off the front axle, so mu (m g s - m a h/L) = m a.
        """
        least = self.friction * gravity * self.driven_share
        return least / (1.0 + self.friction * self.height_over_wheelbase)


def driving_acceleration(trajectory: Trajectory, plant: JudgedPlant | None) -> Any:
    """
    Return the largest driving force at the wheels over the mass of the car in m/s^2, (...).

    The force is the driveshaft's torque over the radius of the wheels. None where the plant is not
    known.
    """
    if plant is None:
        return None
    torque = np.max(trajectory.joint_effort[..., _DRIVESHAFT], axis=-1)
    return torque / (plant.wheel_radius * plant.mass)
