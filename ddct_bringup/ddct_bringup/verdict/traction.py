# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Traction limit of the driven axle, above which the wheels of the car would spin.

The wheels of the plant roll without slip, so a run with a larger driving force is not realistic.
"""

from dataclasses import dataclass

from ddct_bringup.metrics.plant import JudgedPlant


@dataclass(frozen=True)
class TractionRule:
    """Assumptions about tyres and car in a limits file, which gives their reasons."""

    friction: float
    """Friction coefficient mu between tyre and road."""
    driven_share: float | None
    """Share of the weight on the driven front axle at rest, 0 to 1; None for that of the car."""
    height_over_wheelbase: float | None
    """Height of the centre of gravity over the wheelbase, h/L; None for that of the car."""
    reason: str
    """Reason for these values, one line for tables."""

    def limit(self, plant: JudgedPlant) -> float:
        """
        Return the largest driving force over the mass in m/s^2: mu g s / (1 + mu h/L).

        An acceleration a reduces the load on the front axle by m a h/L, so mu (m g s - m a h/L) =
        m a.
        """
        share, height = self.driven_share, self.height_over_wheelbase
        share = plant.driven_share if share is None else share
        height = plant.height_over_wheelbase if height is None else height
        return self.friction * plant.gravity * share / (1.0 + self.friction * height)
