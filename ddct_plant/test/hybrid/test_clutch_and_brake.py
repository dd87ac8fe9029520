# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Two friction elements: Modelica.Mechanics.Rotational.Examples.Friction, two on one body."""

import numpy as np
import pytest
from modes import mode_at

from ddct_plant.hybrid.friction_system import FrictionSystem
from ddct_plant.hybrid.integrator import HybridIntegrator

PIECE_S, PIECES, INTERVALS = 0.001, 10, 300
SWITCH = 50
"""Interval at which the driving torque ends and the brake is applied, at 0.5 s."""
CLUTCH, BRAKE = 0, 1
CLUTCH_TORQUE, BRAKE_TORQUE = 80.0, 800.0
"""Capacities in N m: 0.5 times normal forces of 160 N and 1600 N, at a radius of 1 m."""
EVENTS = [
    (CLUTCH, 'lock', 0.006779708878),
    (CLUTCH, 'release', 0.059339284027),
    (CLUTCH, 'lock', 0.109289826824),
    (CLUTCH, 'release', 0.534248338546),
    (BRAKE, 'lock', 0.640613940788),
    (CLUTCH, 'lock', 1.663641442789),
]
"""Element, kind and time in s of each event, from two other integrators with tight tolerances."""
DYMOLA = (
    0.0067797089998,
    0.0593400563591,
    0.1092894952219,
    0.5342486453749,
    0.6406138053531,
    1.6636397837258,
)
"""Times of the same events in s from Dymola at tolerance 1e-6."""


def friction_example() -> FrictionSystem:
    """
    Return inertias 3, 2 and 1, the spring between the last two, and the torque as an oscillator.

    States: three speeds, the twist of the spring, 200 sin(100 t) and 200 cos(100 t).
    """
    stiffness, damping = 160.0, 1.0
    a = np.zeros((6, 6))
    a[0, 4] = 1.0
    a[1, 1:4] = np.array([-damping, damping, -stiffness]) / 0.05
    a[2, 1:4] = damping, -damping, stiffness
    a[3, 1:3] = 1.0, -1.0
    a[4, 5], a[5, 4] = 100.0, -100.0
    h = np.zeros((2, 6))
    h[CLUTCH, :2] = 1.0, -1.0
    h[BRAKE, 2] = 1.0
    inertias = np.array([1.0, 0.05, 1.0, 1.0, 1.0, 1.0])
    return FrictionSystem(a, np.zeros((6, 0)), -h.T / inertias[:, None], h)


def simulated() -> tuple[list[tuple[int, str, float]], list[float]]:
    """Return element, kind and time in s of each event, and the state at 3 s."""
    integrator = HybridIntegrator(friction_example(), PIECE_S, PIECES, held=[0, 1])
    state = [100.0, 90.0, 90.0, 0.0, 0.0, 200.0]
    signs = mode_at(integrator.system, state)
    events = []
    for interval in range(INTERVALS):
        braking = interval >= SWITCH
        if braking:
            state[4:] = 0.0, 0.0
        capacities = [CLUTCH_TORQUE, BRAKE_TORQUE if braking else 0.0]
        done = integrator.advance(state, signs, [], capacities, capacities)
        start_s = interval * PIECES * PIECE_S
        events += [(event.element, event.kind, start_s + event.time_s) for event in done.events]
        state, signs = done.state, done.signs
    return events, state


def test_every_event_of_clutch_and_brake_is_within_1e_8_s_of_two_other_integrators():
    events, state = simulated()
    assert [event[:2] for event in events] == [event[:2] for event in EVENTS]
    times = [time_s for *_, time_s in events]
    assert times == pytest.approx([time_s for *_, time_s in EVENTS], abs=1e-8)
    assert times == pytest.approx(DYMOLA, abs=3e-6)
    assert state[0] == pytest.approx(2.2898714711, abs=1e-8)
    assert state[0] == pytest.approx(2.289890998276737, abs=3e-5)
    assert state[1] == pytest.approx(state[0], abs=1e-14)


def two_clutches(first: float, second: float) -> FrictionSystem:
    """Return a damped engine, a sprung shaft and its angle, and clutches of two ratios."""
    a = np.array([[-0.08, 0.0, 0.0, 0.0], [0.0, -1.2, -400.0, 0.0], [0.0, 1.0, 0.0, 0.0]])
    a = np.vstack([a, [1.0, 0.0, 0.0, 0.0]])
    h = np.array([[1.0, -first, 0.0, 0.0], [1.0, -second, 0.0, 0.0]])
    g = -h.T / np.array([[0.25], [3.5], [1.0], [1.0]])
    return FrictionSystem(a, np.array([[4.0], [0.0], [0.0], [0.0]]), g, h)


@pytest.mark.parametrize('first', [16.0602, 12.3, 7.7])
@pytest.mark.parametrize('second', [9.3416, 5.90933, 4.1, 3.3])
def test_two_elements_that_stop_a_damped_body_together_leave_it_without_any_motion(first, second):
    integrator = HybridIntegrator(two_clutches(first, second), PIECE_S, PIECES, held=[0, 1, 2])
    state = [20.0, 1.5, 0.0, 0.0]
    signs = mode_at(integrator.system, state)
    for _ in range(100):
        done = integrator.advance(state, signs, [30.0], [200.0, 200.0], [200.0, 200.0])
        state, signs = done.state, done.signs
    assert signs == (0, 0)
    assert state[:2] == [0.0, 0.0]
