# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""What each clutch of a shift carries while the on-coming one takes over."""

from dataclasses import dataclass
from typing import Any, NamedTuple, Self

from ddct_plant.models.gearbox import EngagedGear
from ddct_plant.shift.gear_pair import GearPair


@dataclass(frozen=True)
class OffGoingBalance:
    """
    What a locked off-going clutch carries in a rigid driveline with both gears engaged.

    With r = tau_i/tau_j, and J and c of both shafts at the off-going one,
    (J_m + J + J_v/tau_i^2) dw/dt = C_m - (c_m + c) w - (1 - 1/r) C_2 - C_load/tau_i, and
    C_1 = C_m - c_m w - C_2 - J_m dw/dt. Values may be numbers or arrays, with which it is the
    balance of many runs.
    """

    off_going: EngagedGear
    """Off-going gear i."""
    engine_inertia: float
    """J_m in kg m^2."""
    engine_damping: float
    """c_m in N m s/rad."""
    inertia: float
    """J_m + J + J_v/tau_i^2 in kg m^2."""
    shaft_damping: float
    """c in N m s/rad."""
    relief: float
    """1 - 1/r: C_2 slows the engine down and drives the wheels less."""

    @classmethod
    def of(cls, gears: GearPair) -> Self:
        """Return the balance of two gears."""
        p, gear, ratio = gears.in_off_going_gear, gears.off_going, gears.ratio
        share = 1.0 + ratio**-2
        return cls(
            gear,
            p.engine_inertia,
            p.engine_damping,
            p.engine_inertia + share * p.shaft_inertia + gear.at_shaft(p.vehicle_inertia),
            share * p.shaft_damping,
            1.0 - 1.0 / ratio,
        )

    def torque(
        self,
        engine_torque: Any,
        load_torque: Any,
        engine_speed: Any,
        on_coming_torque: Any = 0.0,
    ) -> Any:
        """Return C_1 in N m for C_m, C_load of everything that resists, w_m in rad/s and C_2."""
        delivered = engine_torque - self.engine_damping * engine_speed
        resisting = self.off_going.shaft_torque(load_torque) + self.shaft_damping * engine_speed
        acceleration = (delivered - self.relief * on_coming_torque - resisting) / self.inertia
        return delivered - on_coming_torque - self.engine_inertia * acceleration


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
