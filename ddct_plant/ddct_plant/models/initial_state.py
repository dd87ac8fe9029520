# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The state of the driveline and the torques before t_0."""

from dataclasses import dataclass

from ddct_plant.models.driveline_model import ANGLES


@dataclass(frozen=True)
class InitialSide:
    """Shaft and clutch of one side of the gearbox before t_0."""

    shaft_speed: float
    """Speed of the primary shaft in rad/s."""
    torque_request: float = 0.0
    """Torque request in N m, on which the actuator is at rest."""
    torque: float = 0.0
    """Transmitted torque of the clutch in N m."""
    open: bool = False
    """Whether the capacity of the clutch is zero, also at equal speeds of the plates."""


@dataclass(frozen=True)
class InitialState:
    """
    Speeds, driveshaft twist and the torques that hold before t_0.

    The wheel turns with the primary shaft of an engaged gear (w_sr = 0); theta_sr balances the
    load, and with the equilibrium `full` and in a shift what accelerates the vehicle too.
    """

    engine_speed: float
    """Engine speed w_m(0) in rad/s."""
    wheel_speed: float
    """Wheel speed w_r(0) in rad/s."""
    twist: float
    """Twist of the driveshaft theta_sr(0) in rad."""
    engine_torque: float
    """Engine torque C_m(0) in N m."""
    load_torque: float
    """Load torque C_load(0) in N m."""
    sides: tuple[InitialSide, ...]
    """Clutch and primary shaft; in a shift those of the on-coming side, then of the off-going."""
    wheel_torque: float = 0.0
    """Friction of rolling and brake at the wheel in N m; 0 where C_load includes the rolling."""

    @property
    def states(self) -> list[float]:
        """Values of the driveline's states, in the order of its model."""
        return [self.engine_speed, self.sides[0].shaft_speed, self.wheel_speed, self.twist]

    @property
    def values(self) -> list[float]:
        """States, angles that start at zero, and speed and angle of the off-going shaft."""
        values = [*self.states, *[0.0] * len(ANGLES)]
        for side in self.sides[1:]:
            values += side.shaft_speed, 0.0
        return values
