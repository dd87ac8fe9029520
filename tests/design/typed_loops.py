# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
The thesis's loops typed from its formulas, by python-control.

339.4 stands for 334.4 in P_2. Only the identified parameters are the product's, so that a number
can be compared to all its digits.
"""

import functools
import itertools
import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from ddct_plant.models.parameters import DrivelineParameters

if TYPE_CHECKING:
    import control

DT = 0.01
RPM = 30.0 / math.pi
P = DrivelineParameters()
IDENTIFIED = [P.engine_inertia, P.shaft_inertia, P.shaft_damping, P.halfshaft_damping]
IDENTIFIED += [P.halfshaft_stiffness, P.gear.total_ratio, P.vehicle_inertia]


def driveline(factors: tuple[float, ...] = (1.0,) * 7) -> 'control.StateSpace':
    """
    Return A of Section 1.5 as a system from C_f to the slip speed in rpm.

    `factors` multiply J_m, J_p, c_prim, c_sa, k_sa, tau and J_v.
    """
    import control

    j_m, j_p, c_p, c, k, tau, j_v = np.multiply(IDENTIFIED, factors)
    a = [
        [0.0, 0.0, 0.0, 0.0],
        [0.0, -(c / tau**2 + c_p) / j_p, c / (j_p * tau), -k / (j_p * tau)],
        [0.0, c / (j_v * tau), -c / j_v, k / j_v],
        [0.0, 1.0 / tau, -1.0, 0.0],
    ]
    b = [[-1.0 / j_m], [1.0 / j_p], [0.0], [0.0]]
    return control.ss(a, b, [[RPM, -RPM, 0.0, 0.0]], [[0.0]])


def printed(gain: float, numerator: list, denominator: list) -> 'control.StateSpace':
    """Return gain times factors [1, a] or [1, b, c], each pair of factors a system of its own."""
    import control

    system = control.ss([], [], [], [[gain]])
    numerator = [[1.0]] * (len(denominator) - len(numerator)) + numerator
    for top, bottom in zip(sorted(numerator, key=len), sorted(denominator, key=len), strict=True):
        system = system * control.tf2ss(top, bottom)
    return system


@functools.cache
def g_a() -> 'control.StateSpace':
    return printed(25.305, [[1, 138], [1, -161.3, 31340]], [[1, 82.23, 2563], [1, 134.1, 42700]])


@functools.cache
def hinf1() -> 'control.StateSpace':
    return printed(
        -0.012266,
        [[1, 0.7567], [1, 0.009368], [1, 82.23, 2563], [1, 121.4, 7696], [1, 134.1, 4.27e4]],
        [[1, 0], [1, 0.005905], [1, 89.52 + 138.0, 89.52 * 138.0], [1, 5.344, 339.4]]
        + [[1, 146.2, 2.914e4]],
    )


@functools.cache
def hinf2() -> 'control.StateSpace':
    return printed(
        -0.48353,
        [[1, 206.6], [1, 7.48], [1, 0.01008], [1, 82.23, 2563], [1, 121.4, 7696]],
        [[1, 0], [1, 303.1], [1, 0.01729], [1, 202.0 + 138.0, 202.0 * 138.0], [1, 5.344, 339.4]],
    )


def g_c1(gain: float) -> 'control.StateSpace':
    return printed(gain, [[1, 9.6], [1, 1], [1, 1]], [[1, 0], [1, 16], [1, 16], [1, 0.6]])


def g_c2(gain: float) -> 'control.StateSpace':
    return printed(gain, [[1, 0.8361], [1, 74.29, 2393]], [[1, 0], [1, 5.325, 339.3]])


def sampled(controller: 'control.StateSpace', wear_gain: float = 1.0) -> 'control.StateSpace':
    """Return the loop under zero-order hold, with the actuator's delay of a sample."""
    import control

    delay = control.ss([[0.0]], [[1.0]], [[1.0]], [[0.0]], DT)
    plant = control.c2d(driveline() * g_a(), DT, 'zoh')
    return control.c2d(controller, DT, 'zoh') * delay * plant * wear_gain


def peaks(loop: 'control.StateSpace', delay_s: float = 0.0) -> tuple[float, float]:
    """Return M_s and M_t on a grid of 30 000 frequencies."""
    omega = np.geomspace(0.1, math.pi / DT * 0.9999, 30_000)
    at = 1j * omega if not loop.dt else np.exp(1j * omega * DT)
    values = loop(at) * np.exp(-1j * omega * delay_s)
    return np.abs(1.0 / (1.0 + values)).max(), np.abs(values / (1.0 + values)).max()


def rise_and_overshoot(loop: 'control.StateSpace', step_s: float) -> tuple[float, float]:
    """Return the first time at the final value 1 and the overshoot in percent."""
    import control

    time = np.arange(0.0, 8.0, step_s)
    closed = control.feedback(loop, 1)
    response = control.step_response(closed, time).outputs
    first = int(np.argmax(response >= 1.0))
    rise = np.interp(1.0, response[first - 1 : first + 1], time[first - 1 : first + 1])
    return float(rise), 100.0 * (float(response.max()) - 1.0)


def corner_plants() -> 'Iterator[control.StateSpace]':
    """Yield the plant with hold, without delay, at each corner 20 % off the identified values."""
    import control

    for factors in itertools.product((0.8, 1.2), repeat=7):
        yield control.c2d(driveline(factors) * g_a(), DT, 'zoh')
