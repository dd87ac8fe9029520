# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The driveline's step is exact, and what it shows is consistent."""

import numpy as np
import pytest
import scipy

from ddct_plant.models.driveline_model import driveline_matrices
from ddct_plant.models.linear_driveline import Driveline
from ddct_plant.models.static_torque import constant_slip_torque
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.initial_state import initial_state
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')), CaseSettings(wear_gain=0.8))
SCENARIO = SETTINGS.scenario
INITIAL = initial_state(SETTINGS)


def make_driveline() -> Driveline:
    return Driveline(SCENARIO.driveline, SCENARIO.vehicle, INITIAL)


def integrated(engine: float, load: float, nodes: np.ndarray, state: np.ndarray) -> np.ndarray:
    """Return the seven states after one period by a tight-tolerance integration."""
    model = driveline_matrices(SCENARIO.driveline)

    def derivative(time: float, x: np.ndarray) -> np.ndarray:
        clutch = np.interp(time, np.linspace(0.0, 0.01, 11), nodes)
        motion = model.a @ x[:4] + model.b @ [engine, clutch, load]
        return np.concatenate([motion, x[:3]])

    # Millisecond by millisecond, so that no step straddles a bend of the clutch torque.
    for part in range(10):
        span = (0.001 * part, 0.001 * (part + 1))
        solution = scipy.integrate.solve_ivp(
            derivative, span, state, method='DOP853', rtol=1e-12, atol=1e-12
        )
        state = solution.y[:, -1]
    return state


def test_a_step_equals_a_tight_tolerance_integration():
    """Each state within 1e-10 of its size after 20 periods of rough torques."""
    random = np.random.default_rng(1)
    driveline = make_driveline()
    start = [
        INITIAL.engine_speed,
        INITIAL.sides[0].shaft_speed,
        INITIAL.wheel_speed,
        INITIAL.twist,
    ]
    state = np.array([*start, 0.0, 0.0, 0.0])
    for _ in range(20):
        engine, load = random.uniform(0.0, 300.0), random.uniform(0.0, 100.0)
        nodes = random.uniform(0.0, 350.0, 11)
        driveline.step(engine, load, nodes.tolist())
        state = integrated(engine, load, nodes, state)
    now = driveline.outputs()
    found = [*now.joint_speed[:3], now.joint_position[3], *now.joint_position[:3]]
    assert found == pytest.approx(state, rel=1e-10)


def test_efforts_are_left_limits():
    driveline = make_driveline()
    driveline.step(100.0, 50.0, [float(torque) for torque in range(11)])
    engine, clutch, load, _ = driveline.outputs().joint_effort
    assert (engine, clutch, load) == (100.0, 10.0, 50.0)


def test_at_t0_the_clutch_transmits_the_worn_open_loop_torque_and_the_shaft_holds_the_load():
    now = make_driveline().outputs()
    engine, clutch, load, shaft = now.joint_effort
    expected = constant_slip_torque(SCENARIO.driveline, engine, load)
    assert clutch == pytest.approx(0.8 * expected, rel=1e-12)
    assert shaft == pytest.approx(load, rel=1e-12)
    assert now.vehicle_accel == pytest.approx(0.0, abs=1e-12)


def test_acceleration_integrates_to_speed():
    """The speed gained over a period is Simpson's rule over its acceleration, within 1e-4."""
    model = driveline_matrices(SCENARIO.driveline)
    driveline = make_driveline()
    torques = [175.0] * 11
    for _ in range(30):
        driveline.step(200.0, 60.0, torques)
    before = driveline.outputs()
    driveline.step(200.0, 60.0, torques)
    after = driveline.outputs()
    state = np.array([*before.joint_speed[:3], before.joint_position[3]])
    half = scipy.integrate.solve_ivp(
        lambda _, x: model.a @ x + model.b @ [200.0, 175.0, 60.0],
        (0.0, 0.005),
        state,
        method='DOP853',
        rtol=1e-12,
        atol=1e-12,
    ).y[:, -1]
    twist_speed = model.c[1] @ half
    p = SCENARIO.driveline
    shaft = p.halfshaft_damping * twist_speed + p.halfshaft_stiffness * half[3]
    middle = SCENARIO.vehicle.wheel_radius_m * (shaft - 60.0) / p.vehicle_inertia
    gained = 0.01 / 6.0 * (before.vehicle_accel + 4.0 * middle + after.vehicle_accel)
    assert after.vehicle_speed - before.vehicle_speed == pytest.approx(gained, rel=1e-4)


def test_constant_slip_torque_keeps_the_slip_nearly_constant():
    """The slip drifts by less than 1 % of what the engine alone would make it gain."""
    driveline = make_driveline()
    torque = constant_slip_torque(SCENARIO.driveline, 200.0, INITIAL.load_torque)
    for _ in range(200):
        driveline.step(200.0, INITIAL.load_torque, [torque] * 11)
    free_gain = 200.0 / SCENARIO.driveline.engine_inertia * 2.0
    assert abs(driveline.outputs().slip_speed) < 0.01 * free_gain
