# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The hybrid integrator on Modelica.Mechanics.Rotational.Examples.CoupledClutches."""

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import scipy
from modes import mode_at

from ddct_plant.hybrid.friction_system import FrictionSystem
from ddct_plant.hybrid.integrator import HybridIntegrator

pytestmark = pytest.mark.slow

PIECE_S, PIECES, INTERVALS = 2e-5, 50, 1500
STATIC_RATIO = 1.1
END_S = 1.5
DYMOLA = {
    (2, 'lock'): [0.709621464],
    (1, 'lock'): [0.791658284, 0.906849138],
    (1, 'release'): [0.831108506, 1.000295860],
    (3, 'lock'): [1.143969630],
}
"""Times of the events in s by clutch, Dymola at tolerance 1e-6."""
DYMOLA_END = (3.247035, 2.463208)
"""w1, and w2 = w3 = w4, in rad/s."""


def driving_torque(time: Any) -> Any:
    """Return the torque in N m at times in s: a number or an array."""
    return 10.0 * np.sin(10.0 * np.pi * time)


def first_capacity(time: Any) -> Any:
    """Return the capacity of clutch 1 in N m at times in s: a number or an array."""
    return 10.0 * np.maximum(np.cos(0.4 * np.pi * time), 0.0)


def driven(start: float, end: float) -> float:
    """Return the integral of the driving torque."""
    return (np.cos(10.0 * np.pi * start) - np.cos(10.0 * np.pi * end)) / np.pi


def carried(start: float, end: float) -> float:
    """Return the integral of the capacity of clutch 1, which is zero from 1.25 s."""
    end, start = min(end, 1.25), min(start, 1.25)
    return 25.0 / np.pi * (np.sin(0.4 * np.pi * end) - np.sin(0.4 * np.pi * start))


def root(function: Callable[[float], float], low: float, high: float) -> float:
    return scipy.optimize.brentq(function, low, high, xtol=1e-15, rtol=1e-15)


def closed_form() -> tuple[dict[tuple[int, str], list[float]], tuple[float, float]]:
    """
    Return times and end speeds from the integrals of each phase.

    All inertias are 1. The order of the phases is Dymola's; each equation is that of its phase.
    """
    lock_2 = root(lambda t: carried(0.0, t) - 20.0 * (t - 0.4), 0.6, 0.8)
    speed_2 = 10.0 * (lock_2 - 0.4)

    def slip_1(t: float) -> float:
        return 10.0 + driven(0.0, t) - carried(0.0, t) - speed_2 - carried(lock_2, t) / 2.0

    lock_1 = root(slip_1, 0.75, 0.83)
    speed_1 = speed_2 + carried(lock_2, lock_1) / 2.0
    release_1 = root(
        lambda t: 2.0 / 3.0 * driving_torque(t) - STATIC_RATIO * first_capacity(t), 0.8, 0.84
    )
    speed_release = speed_1 + driven(lock_1, release_1) / 3.0

    def slip_again(t: float) -> float:
        return driven(release_1, t) - 1.5 * carried(release_1, t) + 10.0 * (t - 0.9) / 2.0

    again = root(slip_again, 0.9, 0.95)
    speed_again = speed_release + driven(release_1, again) - carried(release_1, again)
    last = root(
        lambda t: (2.0 * driving_torque(t) + 10.0) / 3.0 - STATIC_RATIO * first_capacity(t),
        0.98,
        1.02,
    )
    speed_last = speed_again + (driven(again, last) - 10.0 * (last - again)) / 3.0

    def slip_3(t: float) -> float:
        rear = speed_last + (carried(last, t) - 10.0 * (t - last)) / 2.0
        return rear - 10.0 * (t - 0.9)

    lock_3 = root(slip_3, 1.05, 1.2)
    end_1 = speed_last + driven(last, END_S) - carried(last, END_S)
    end_4 = 10.0 * (lock_3 - 0.9) + carried(lock_3, END_S) / 3.0
    times = {
        (2, 'lock'): [lock_2],
        (1, 'lock'): [lock_1, again],
        (1, 'release'): [release_1, last],
        (3, 'lock'): [lock_3],
    }
    return times, (end_1, end_4)


def simulated(torque_as_states: bool) -> tuple[dict[tuple[int, str], list[float]], np.ndarray]:
    """Return event times after 0.4 s by clutch, and the state at the end."""
    h = np.zeros((3, 6))
    h[:, :4] = [[1, -1, 0, 0], [0, 1, -1, 0], [0, 0, 1, -1]]
    a = np.zeros((6, 6))
    a[4, 5], a[5, 4] = 10.0 * np.pi, -10.0 * np.pi
    a[0, 4] = 10.0 if torque_as_states else 0.0
    system = FrictionSystem(a, np.eye(6)[:, :1], -h.T, h)
    integrator = HybridIntegrator(system, PIECE_S, PIECES)
    state = np.array([10.0, 0.0, 0.0, 0.0, 0.0, 1.0])
    signs = mode_at(integrator.system, state)
    times: dict[tuple[int, str], list[float]] = {}
    for interval in range(INTERVALS):
        nodes = PIECE_S * (PIECES * interval + np.arange(PIECES + 1))
        torque = 0.0 * nodes if torque_as_states else driving_torque(nodes)
        steps = [10.0 * (interval >= 400), 10.0 * (interval >= 900)]
        kinetic = np.concatenate([first_capacity(nodes), np.repeat(steps, PIECES + 1)])
        done = integrator.advance(state, signs, torque, kinetic, STATIC_RATIO * kinetic)
        state, signs = np.array(done.state), done.signs
        for event in done.events:
            time_s = nodes[0] + event.time_s
            if time_s > 0.4:
                times.setdefault((event.element + 1, event.kind), []).append(time_s)
    return times, state


def test_the_closed_form_is_consistent_with_dymola():
    times, ends = closed_form()
    for key, expected in DYMOLA.items():
        assert times[key] == pytest.approx(expected, abs=5e-6)
    assert ends == pytest.approx(DYMOLA_END, abs=3e-5)
    momentum = ends[0] + 3.0 * ends[1]
    assert momentum == pytest.approx(10.0 + 2.0 / np.pi, abs=1e-12)
    order = [
        *times[2, 'lock'],
        *np.ravel([*zip(times[1, 'lock'], times[1, 'release'], strict=True)]),
    ]
    assert all(early < late for early, late in pairwise([*order, *times[3, 'lock']]))


@pytest.mark.parametrize('torque_as_states', [False, True], ids=['pieces', 'states'])
def test_every_event_is_within_1e_8_s_of_the_closed_form(torque_as_states):
    times, state = simulated(torque_as_states)
    expected, (end_1, end_4) = closed_form()
    assert times.keys() == expected.keys()
    for key in expected:
        assert times[key] == pytest.approx(expected[key], abs=1e-8)
        assert times[key] == pytest.approx(DYMOLA[key], abs=5e-6)
    assert state[:4] == pytest.approx([end_1, *[end_4] * 3], abs=1e-7)
    assert state[:4] == pytest.approx([DYMOLA_END[0], *[DYMOLA_END[1]] * 3], abs=3e-5)
    assert state[1] == pytest.approx(state[3], abs=1e-14)
