# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Limits whose value follows from the simulated car; a limits file has `of_car` for them."""

import math
from collections.abc import Callable, Mapping

from ddct_bringup.metrics.plant import JudgedPlant
from ddct_plant.base.units import rad_s_from_rpm, rpm_from_rad_s

OF_CAR = 'of_car'
"""Value in a limits file of a limit that follows from the car."""
COMFORTABLE_M_S2 = 0.315
"""Weighted acceleration of ISO 2631-1, annex C, below which people are not uncomfortable."""
WORK_TIME_S, WORK_SLIP_RPM = 1.0, 400.0
"""Time in which a slip falls to zero, and the slip from which it does so."""


def weighting(rate: float) -> float:
    """
    Return the gain of W_d of ISO 2631-1 at a frequency in rad/s.

    It is a second-order high-pass at 0.4 Hz with Q = 1/sqrt(2), and (1 + s/w) /
    (1 + s/(0.63 w) + (s/w)^2) with w = 2 pi 2 rad/s.
    """
    high, low = math.tau * 0.4 / (1j * rate), 1j * rate / (math.tau * 2.0)
    return abs(
        (1.0 + low) / (1.0 + low / 0.63 + low * low) / (1.0 + math.sqrt(2.0) * high + high * high)
    )


def judder_limit(plant: JudgedPlant) -> float:
    """
    Return the r.m.s. of w_sr in whole rpm that gives the weighted acceleration alone.

    It swings at the natural frequency of the locked driveline, w^2 = k_sa (1/(tau^2 (J_m + J_p)) +
    1/J_v), where A_x = (r_w/J_v) (c_sa + k_sa/(j w)) w_sr.
    """
    engine_side = plant.gear.wheel_torque(plant.gear.shaft_speed(plant.engine_side_inertia))
    per_inertia = 1.0 / engine_side + 1.0 / plant.vehicle_inertia
    rate = math.sqrt(plant.halfshaft_stiffness * per_inertia)
    torque = abs(plant.halfshaft_damping + plant.halfshaft_stiffness / (1j * rate))
    acceleration = plant.wheel_radius / plant.vehicle_inertia * torque
    return float(round(rpm_from_rad_s(COMFORTABLE_M_S2 / weighting(rate) / acceleration)))


def friction_work_limit(plant: JudgedPlant) -> float:
    """
    Return 1 + C t/(J_m w_d), the work over the least of a slip w_d that falls to zero in t.

    C is the working torque of the clutch; the value is in whole numbers.
    """
    momentum = plant.engine_inertia * rad_s_from_rpm(WORK_SLIP_RPM)
    return float(round(1.0 + plant.working_torque * WORK_TIME_S / momentum))


LIMITS_OF_CAR: Mapping[str, Callable[[JudgedPlant], float]] = {
    'judder_rpm': judder_limit,
    'friction_work_over_least': friction_work_limit,
}
"""Functions of the car by the metric that they limit."""
