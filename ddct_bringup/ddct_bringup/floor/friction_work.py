# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Closed-form lower bound of the friction work, from the energy balance of a rigid car."""

import math

from ddct_bringup.floor.case import Case
from ddct_bringup.metrics.plant import JudgedPlant


def least_friction_work(case: Case) -> float:
    """
    Return the least friction work in J after control start of a rigid car that locks then.

    J_r = J_m J_eq/(J_m + J_eq) with J_eq = J_p + J_v/tau^2, and a = C_m/J_m + C_load/(tau J_eq).
    The slip of a rigid car keeps J_r dw_d/dt = J_r a - C_f, so that the work, the integral of
    C_f w_d, is J_r w_d^2/2 plus J_r times the integral of a w_d. The slip falls at most as with
    the greatest capacity C, w_d - C t/J_r: that gives the second part, with the least a of the
    time. A car with a soft driveline may do with less, as energy goes into its twist.
    """
    plant = JudgedPlant.of(case.settings.scenario)
    joint = plant.joint_inertia
    slip = abs(case.start.slip)
    work = joint * slip**2 / 2.0
    if math.isinf(case.capacity.most) or case.start.slip <= 0.0:
        return work
    periods = max(case.lock.periods, 1)
    engine, load = case.engine, case.load
    torque = (engine.offset + engine.slope * case.tube.engine_low + engine.low)[:periods].min()
    resisting = (load.offset + load.slope * case.tube.wheel_low + load.low)[:periods].min()
    drive = torque / plant.engine_inertia + plant.gear.shaft_torque(resisting) / plant.rest_inertia
    fastest = case.capacity.most / joint
    time_s = min(case.lock.time_s, slip / fastest)
    area = slip * time_s - fastest * time_s**2 / 2.0
    return work + joint * max(float(drive), 0.0) * area
