# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The program of an inertia phase against closed forms of the rigid car and short steps."""

import numpy as np
import pytest
from shift_cases import settings_of

from ddct_bringup.floor.case import case_at
from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.dynamics.shapes import SHAPES, most_shapes, shape_effects
from ddct_bringup.floor.friction_work import least_friction_work
from ddct_plant.linear.sampling import hold_inputs
from ddct_plant.models.driveline_model import states_and_torques
from ddct_plant.scenario.rules.shift import gears_of

LOCK_S = 0.4
UNDAMPED = (
    'driveline.engine_damping=0',
    'driveline.shaft_damping=0',
    'load.drag_coefficient=0',
)


def test_engine_shafts_and_car_have_the_momentum_of_a_rigid_car():
    """
    Without damping and drag J_m w_m + J_p (1 + r^2) w_p2 + J_v w_r/tau_j is that of a rigid car.

    It grows by the impulse of C_m - C_load/tau_j, and by r - 1 times that of C_1, as that clutch
    is in a shorter gear. C_2 takes as much from the engine as it gives to the shaft.
    """
    settings = settings_of(overrides=UNDAMPED, handover='timed')
    gears, start = gears_of(settings.scenario), control_start(settings)
    p, tau = gears.both_engaged, gears.on_coming.gear.wheel_speed(1.0)
    motion = case_at(settings, start, LOCK_S, limited=False).motion
    columns, steps = motion.columns, len(motion.slip)
    engine, wheel = motion.engine_speed[1 : steps + 1], motion.wheel_speed[1 : steps + 1]
    shaft = engine - motion.slip
    momentum = p.engine_inertia * engine + p.shaft_inertia * shaft
    momentum += p.vehicle_inertia * tau * wheel
    last = momentum[-1]
    np.testing.assert_allclose(last[1 : 1 + columns.requests], 0.0, atol=1e-9)
    shapes = last[columns.off_going].reshape(-1, SHAPES)
    expected = [(gears.ratio - 1.0) * 0.01, 0.0, 0.0, 0.0]
    np.testing.assert_allclose(shapes, np.broadcast_to(expected, shapes.shape), atol=1e-9)
    nodes = motion.capacity[:steps]
    impulse = 0.001 * (nodes.sum(axis=1) - (nodes[:, 0] + nodes[:, -1]) / 2.0).sum(axis=0)
    requests = slice(1, 1 + columns.requests)
    taken = p.engine_inertia * engine[-1, requests]
    np.testing.assert_allclose(taken, -impulse[requests], atol=1e-9)


@pytest.mark.parametrize('place', range(SHAPES))
def test_a_shape_has_the_effect_of_its_torque(place):
    """Against many short steps of the equations, with C_1 on the engine and r C_1 on the gears."""
    gears = gears_of(settings_of().scenario)
    p, tau = gears.both_engaged, gears.on_coming.gear.wheel_speed(1.0)
    steps = 20000
    at = (np.arange(steps) + 0.5) / steps
    state, h = np.zeros(4), 0.01 / steps
    for torque in np.polynomial.legendre.Legendre.basis(place, domain=[0.0, 1.0])(at):
        engine, shaft, wheel, twist = state
        speed = shaft * tau - wheel
        driveshaft = p.halfshaft_damping * speed + p.halfshaft_stiffness * twist
        rates = (
            (-p.engine_damping * engine - torque) / p.engine_inertia,
            (gears.ratio * torque - p.shaft_damping * shaft - tau * driveshaft) / p.shaft_inertia,
            driveshaft / p.vehicle_inertia,
            speed,
        )
        state = state + h * np.array(rates)
    largest = np.abs(state) + 1e-3 * np.abs(state).max()
    assert np.all(np.abs(shape_effects(gears)[:, place] - state) < 1e-2 * largest)


@pytest.mark.parametrize('seed', range(20))
def test_any_torque_within_the_capacity_has_coefficients_within_their_bounds(seed):
    """Torques that jump between plus and minus the capacity reach farthest."""
    random = np.random.default_rng(seed)
    gears = gears_of(settings_of().scenario)
    capacity = np.sort(random.uniform(0.0, 50.0, size=(1, 11)))[:, ::-1]
    parts = 2000
    at = (np.arange(parts) + 0.5) / parts
    switches = np.sort(random.uniform(size=random.integers(0, 4)))
    signs = random.choice([-1.0, 1.0]) * (-1.0) ** np.searchsorted(switches, at)
    a, b = states_and_torques(gears.both_engaged)
    # C_1 acts on the engine as C_2 does, and r times as much on the shaft.
    column = b[:, [1]] * np.array([[1.0], [gears.ratio], [1.0], [1.0]])
    step, held = hold_inputs(a, column, 0.01 / parts)
    state = np.zeros(4)
    for torque in signs * np.interp(10.0 * at, np.arange(11), capacity[0]):
        state = step @ state + held[:, 0] * torque
    coefficients = np.linalg.solve(shape_effects(gears), state)
    assert np.all(np.abs(coefficients) <= most_shapes(gears, capacity)[0])


def test_the_least_friction_work_of_a_heavy_car_is_that_of_the_engine():
    """J_m dw^2/2 cannot be avoided; a linear slip does C_m dw t/2 more."""
    settings = settings_of(overrides=('vehicle.mass_kg=1e6',), handover='slip')
    start = control_start(settings)
    case = case_at(settings, start, LOCK_S, limited=False)
    engine = settings.scenario.driveline.engine_inertia * start.slip**2 / 2.0
    linear = engine + 100.0 * start.slip * LOCK_S / 2.0
    assert 0.97 * engine < least_friction_work(case) - start.friction_work < linear
