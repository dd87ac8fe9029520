# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The state of the driveline and the torques before t_0."""

from dataclasses import dataclass

from ddct_plant.models.driveline_model import STATES


@dataclass(frozen=True)
class InitialState:
    """
    Speeds, driveshaft twist and the torques that hold before t_0.

    The wheel turns with the primary shaft (w_sr = 0); theta_sr balances the load, and with the
    equilibrium `full` what accelerates the vehicle too. The actuator is at rest on
    `torque_request`, which the clutch transmits times the wear gain.
    """

    engine_speed: float
    """Engine speed w_m(0) in rad/s."""
    shaft_speed: float
    """Speed of the primary shaft w_p(0) in rad/s."""
    wheel_speed: float
    """Wheel speed w_r(0) in rad/s."""
    twist: float
    """Twist of the driveshaft theta_sr(0) in rad."""
    engine_torque: float
    """Engine torque C_m(0) in N m."""
    load_torque: float
    """Load torque C_load(0) in N m."""
    torque_request: float
    """
    Torque request before t_0 in N m: C_fOL(0) in `detailed`, 0 elsewhere and where the clutch of
    the scenario is open.
    """
    clutch_torque: float
    """Transmitted torque C_f before t_0 in N m."""
    wheel_torque: float = 0.0
    """Friction of rolling and brake at the wheel in N m; 0 where C_load includes the rolling."""
    clutch_open: bool = False
    """Whether the capacity of the clutch is zero before t_0, also at equal speeds of the
    plates."""

    @property
    def states(self) -> list[float]:
        """Values of the driveline's states, in the order of its model."""
        return [getattr(self, name) for name in STATES]
