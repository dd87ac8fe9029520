# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Numbers of `least_jerk` in the exported C, by their names there."""

import numpy as np

from ddct_controllers.c_code.parts import MEASURED_MACROS, authority_macros
from ddct_controllers.least_jerk import (
    controller,
    demand_trend,
    engine_guard,
    lock,
    plan,
    shaped_demand,
    slip_estimate,
    torque_estimate,
    torque_plan,
)
from ddct_controllers.least_jerk.actuator_model import AHEAD, ActuatorTorque
from ddct_controllers.least_jerk.design import LeastJerkDesign
from ddct_plant.base.timebase import PERIOD_S


def macros_of(design: LeastJerkDesign) -> dict[str, int | float]:
    """Return the macros of a design; squares and quotients as Python rounds them."""
    return {
        'PERIOD': PERIOD_S,
        'STICKS': int(design.sticks),
        'SHIFTS': int(design.shifts),
        'INITIAL_REQUEST': design.initial_request,
        **MEASURED_MACROS,
        **_driveline(design),
        **_estimates(design),
        **_plan(design),
        **_guard(design),
        **_engine(design),
        **_lock(),
    }


def arrays_of() -> dict[str, np.ndarray]:
    """Return the constant vectors and matrices: the actuator by periods."""
    model = ActuatorTorque()
    return {
        'STEP': np.array(model.step),
        'HELD': np.array(model.held),
        'MEAN': np.array(model.mean),
        'TOTAL': np.array(model.total),
        'AT_REST': np.array(model.at_rest),
    }


def _driveline(design: LeastJerkDesign) -> dict[str, int | float]:
    p = design.driveline
    return {
        'ENGINE_INERTIA': p.engine_inertia,
        'ENGINE_DAMPING': p.engine_damping,
        'VEHICLE_INERTIA': p.vehicle_side_inertia,
        'TOTAL_RATIO': p.gear.total_ratio,
        'WHEEL_DAMPING': p.gear.wheel_torque(p.shaft_damping),
        'COUNTS_DAMPING': int(design.static.equilibrium == 'full'),
    }


def _estimates(design: LeastJerkDesign) -> dict[str, int | float]:
    t, options, slip = torque_estimate, design.options, design.slip()
    step = design.clutch().step
    return {
        'STATES': len(ActuatorTorque().at_rest),
        'AHEAD': AHEAD,
        'LAG': controller.LAG_S,
        'SPEED_STEP': step,
        'SPEED_VARIANCE': t.SPEED_NOISE_RAD_S**2,
        'PROCESS_VARIANCE': (step * t.ENGINE_TORQUE_NOISE_N_M) ** 2,
        'INITIAL_GAIN_VARIANCE': t.INITIAL_GAIN**2,
        'INITIAL_OFFSET_VARIANCE': t.INITIAL_OFFSET_N_M**2,
        'GAIN_DRIFT_VARIANCE': options.gain_drift**2,
        'OFFSET_DRIFT': options.offset_drift_n_m,
        'AT_TORQUE': t.AT_TORQUE_N_M,
        'LEAST_TORQUE': t.LEAST_TORQUE_N_M,
        'LOWEST_GAIN': t.LOWEST_GAIN,
        'HIGHEST_GAIN': t.HIGHEST_GAIN,
        'APPLIED_SHARE': design.applied_share,
        'RIGID_INERTIA': slip.inertia,
        'SHAFT_TWIST': slip.twist_s2,
        'SLIP_SHARE': slip.slip_share,
        'SURPLUS_SHARE': slip.surplus_share,
        'TORQUE_RATE_SHARE': slip_estimate.TORQUE_RATE_SHARE,
        'SLIPPING_SPEED': controller.SLIPPING_RAD_S,
        'STANDING_SPEED': controller.STANDING_RAD_S,
        'OPENING_STEPS': controller.OPENING_STEPS,
        'LONGEST': demand_trend.LONGEST,
        'AFTER_DRIFT': demand_trend.AFTER_DRIFT,
        'AFTER_STEP': demand_trend.AFTER_STEP,
        'EXPLAINED': demand_trend.EXPLAINED_N_M,
        'EXPLAINED_MEAN': demand_trend.EXPLAINED_MEAN_N_M,
        'MEAN_SHARE': demand_trend.MEAN_SHARE,
    }


def _plan(design: LeastJerkDesign) -> dict[str, int | float]:
    limits = design.limits
    return {
        'EASY_RATE': limits.easy_rate,
        'LATEST': limits.latest_s,
        'REFILL': limits.refill_per_s,
        'OPENING': torque_plan.OPENING,
        'REFILLING': torque_plan.REFILLING,
        'LEAST_TIME': limits.least_s,
        'HURRIES': int(limits.hurries),
        'BAND': limits.band,
        'END': limits.end_s,
        'TWIST': limits.twist,
        'SMOOTHING': limits.smoothing_s,
        'SMOOTHING_SHARE': torque_plan.TorquePlan(limits).share,
        'SHORTEST': plan.SHORTEST_S,
        'LEVEL': plan.LEVEL_S,
        'LEAST_SHARE': torque_plan.LEAST_SHARE,
        'CATCH_UP': torque_plan.CATCH_UP,
        'CORRECTION': torque_plan.CORRECTION,
        'GENTLE': torque_plan.GENTLE_S,
        'MISSED': torque_plan.MISSED,
    }


def _guard(design: LeastJerkDesign) -> dict[str, int | float]:
    guard = design.guard()
    return {
        'PER_SPEED': guard.per_speed,
        'LEAST_SPEED': design.speeds.least,
        'HIGHEST_SPEED': guard.highest,
        'IDLE_SPEED': guard.idle,
        'MOST_TORQUE': design.options.most_torque_n_m,
        'MOST_DIP': engine_guard.MOST_DIP_RAD_S,
        'LEAST_RATE': engine_guard.LEAST_RATE_N_M_S,
    }


def _engine(design: LeastJerkDesign) -> dict[str, int | float]:
    return {
        'SHAPING_STEPS': design.shaping_steps,
        'WAIT_STEPS': shaped_demand.WAIT_STEPS,
        **authority_macros(design.authority),
    }


def _lock() -> dict[str, int | float]:
    return {
        'LOCKED_SPEED': lock.LOCKED_RAD_S,
        'AT_START_SPEED': lock.AT_START_RAD_S,
        'PARTED_SPEED': lock.PARTED_RAD_S,
        'PARTED_STEPS': lock.PARTED_STEPS,
        'DWELL_STEPS': lock.DWELL_STEPS,
        'CONFIRMING_STEPS': lock.CONFIRMING_STEPS,
        'CLOSING_RATE': lock.CLOSING_RATE_N_M_S,
        'MOST_REQUEST': lock.MOST_REQUEST_N_M,
        'PARTED_SHARE': controller.PARTED_SHARE,
        'PARTED_TORQUE': controller.PARTED_N_M,
    }
