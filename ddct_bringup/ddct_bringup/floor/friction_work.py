# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Closed-form lower bound of the friction work, from the energy balance of a rigid car."""

import math

from ddct_bringup.floor.case import Case
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_plant.scenario.rules.shift import gears_of


def least_friction_work(case: Case) -> float:
    """
    Return the least friction work in J after control start of a rigid car that locks then.

    J_r = J_m J_eq/(J_m + J_eq) with J_eq = J_p + J_v/tau^2, and a = C_m/J_m + C_load/(tau J_eq).
    The slip of a rigid car keeps J_r dw_d/dt = J_r a - C_f, so that the work, the integral of
    C_f w_d, is J_r w_d^2/2 plus J_r times the integral of a w_d. The slip falls at most as with
    the greatest capacity C, w_d - C t/J_r: that gives the second part, with the least a of the
    time. A car with a soft driveline may do with less, as energy goes into its twist. In a gear
    shift the work of the torque phase comes before, and C_1 takes its share of the slip.
    """
    plant = JudgedPlant.of(case.settings.scenario)
    joint = plant.joint_inertia
    slip = abs(case.start.slip)
    work = case.start.friction_work + joint * slip**2 / 2.0
    if math.isinf(case.capacity.most) or case.start.slip <= 0.0:
        return work
    periods = max(case.lock.periods, 1)
    engine, load = case.engine, case.load
    torque = (engine.offset + engine.slope * case.tube.engine_low + engine.low)[:periods].min()
    resisting = (load.offset + load.slope * case.tube.wheel_low + load.low)[:periods].min()
    drive = torque / plant.engine_inertia + plant.gear.shaft_torque(resisting) / plant.rest_inertia
    fastest = case.capacity.most / joint
    if case.start.off_going:
        taken = _slip_of_off_going(case, plant)
        work -= joint * taken * _most_slip(case, plant, taken)
        slip = max(slip - taken, 0.0)
    time_s = min(case.lock.time_s, slip / fastest)
    area = slip * time_s - fastest * time_s**2 / 2.0
    least = work + joint * max(float(drive), 0.0) * area
    return max(least, case.start.friction_work)


def _slip_of_off_going(case: Case, plant: JudgedPlant) -> float:
    """Return the most slip in rad/s that C_1 takes: its impulse (1/J_m + r/J_eq)."""
    assert case.start.off_going is not None
    ratio = gears_of(case.settings.scenario).ratio
    return case.start.off_going.impulse * (1.0 / plant.engine_inertia + ratio / plant.rest_inertia)


def _most_slip(case: Case, plant: JudgedPlant, taken: float) -> float:
    """Return the highest slip in rad/s until the off-going clutch is open: C_2 is not below 0."""
    assert case.start.off_going is not None
    first = slice(0, case.start.off_going.periods + 1)
    engine, load = case.engine, case.load
    torque = (engine.offset + engine.slope * case.tube.engine_high + engine.high)[first].max()
    resisting = (load.offset + load.slope * case.tube.wheel_high + load.high)[first].max()
    rise = torque / plant.engine_inertia + plant.gear.shaft_torque(resisting) / plant.rest_inertia
    return case.start.slip + case.start.off_going.open_s * max(float(rise), 0.0) + taken
