# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The two gears of a shift, and the driveline with one of them or both engaged."""

from dataclasses import dataclass, replace
from functools import cached_property

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.gearbox import EngagedGear
from ddct_plant.models.parameters import DrivelineParameters


@dataclass(frozen=True)
class GearPair:
    """
    The gears of a shift, each with a primary shaft and a clutch of its own.

    Both primary shafts have the identified inertia J_p and damping c_prim: those of second gear's
    shaft are identified, that those of the other are the same is assumed.
    """

    on_coming: DrivelineParameters
    """Driveline in the on-coming gear j."""
    off_going: EngagedGear
    """Off-going gear i."""

    def __post_init__(self) -> None:
        """Check the gears; raise ParameterError for two of one ratio."""
        if self.off_going == self.on_coming.gear:
            raise ParameterError(
                f'both gears of the shift have the total ratio {self.off_going}: give two gears'
            )

    @cached_property
    def ratio(self) -> float:
        """Speed of the off-going primary shaft over that of the on-coming one, both engaged."""
        return self.off_going.shaft_ratio(self.on_coming.gear)

    @cached_property
    def in_off_going_gear(self) -> DrivelineParameters:
        """Driveline in the off-going gear, as if it were the only one."""
        return self.on_coming.in_gear(self.off_going)

    @cached_property
    def both_engaged(self) -> DrivelineParameters:
        """
        Driveline in the on-coming gear that turns the off-going primary shaft too.

        With w_p1 = r w_p2 and r = tau_i/tau_j its primary shaft has the inertia J_p (1 + r^2) and
        the damping c_prim (1 + r^2), both at the on-coming shaft.
        """
        p, share = self.on_coming, 1.0 + self.ratio**2
        return replace(
            p, shaft_inertia=share * p.shaft_inertia, shaft_damping=share * p.shaft_damping
        )
