# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What each clutch of a shift carries while the on-coming one takes over."""

from typing import NamedTuple

from ddct_plant.shift.gear_pair import GearPair


def off_going_torque(
    gears: GearPair,
    engine_torque: float,
    load_torque: float,
    engine_speed: float,
    on_coming_torque: float = 0.0,
) -> float:
    """
    Return C_1 in N m for C_m, C_load of everything that resists, w_m in rad/s and C_2.

    The driveline is rigid, the off-going clutch is locked and both gears are engaged. With r =
    tau_i/tau_j, and J and c of both shafts at the off-going one,
    (J_m + J + J_v/tau_i^2) dw/dt = C_m - (c_m + c) w - (1 - 1/r) C_2 - C_load/tau_i, and
    C_1 = C_m - c_m w - C_2 - J_m dw/dt.
    """
    p, gear, ratio = gears.in_off_going_gear, gears.off_going, gears.ratio
    share = 1.0 + ratio**-2
    delivered = engine_torque - p.engine_damping * engine_speed
    resisting = gear.shaft_torque(load_torque) + share * p.shaft_damping * engine_speed
    inertia = p.engine_inertia + share * p.shaft_inertia + gear.at_shaft(p.vehicle_inertia)
    acceleration = (delivered - (1.0 - 1.0 / ratio) * on_coming_torque - resisting) / inertia
    return delivered - on_coming_torque - p.engine_inertia * acceleration


LEAST_DEVIATION = -0.9
"""Lowest deviation of the wear gain that a node accepts: a request is divided by 1 plus it."""


class OnComingShare(NamedTuple):
    """Share of the on-coming clutch in C_fOL, and what is known of what that clutch carries."""

    share: float
    """Share of C_fOL that it carries, 0 to 1; feedback starts with 1."""
    wear_deviation: float = 0.0
    """Estimate of its wear gain less 1; 0 where nothing is known."""
    torque_offset: float = 0.0
    """Estimate in N m of what it carries beyond wear gain times request."""

    def request(self, torque: float) -> float:
        """Return the request in N m with which the clutch carries a torque in N m."""
        return (torque - self.torque_offset) / (1.0 + self.wear_deviation)


WHOLE = OnComingShare(1.0)
"""That of a clutch that carries everything, of which nothing is known."""
