# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Sources of the fixed numbers of the design tests: printed formulas and other libraries.

Nothing here is computed by the product: `typed_loops` has the thesis's formulas, which
python-control, scipy and closed forms evaluate.
"""

import math

import numpy as np
import pytest
import scipy
from typed_loops import (
    DT,
    corner_plants,
    driveline,
    g_a,
    g_c1,
    g_c2,
    hinf1,
    hinf2,
    peaks,
    rise_and_overshoot,
    sampled,
)


@pytest.mark.slow
def test_hinf2_on_paper_and_as_it_runs():
    """M_s 1.454, 3.354 with hold and delay, 9.656 worn, 2.79 with 15 ms; 76 %; stable to 1.45."""
    import control

    assert peaks(driveline() * g_a() * hinf2())[0] == pytest.approx(1.454, abs=0.001)
    assert peaks(sampled(hinf2()))[0] == pytest.approx(3.354, abs=0.001)
    assert peaks(sampled(hinf2(), 1.3))[0] == pytest.approx(9.656, abs=0.005)
    assert peaks(driveline() * g_a() * hinf2(), 0.015)[0] == pytest.approx(2.79, abs=0.01)
    assert rise_and_overshoot(sampled(hinf2()), DT)[1] == pytest.approx(76.0, abs=0.1)

    def radius(wear_gain: float) -> float:
        return np.abs(control.feedback(sampled(hinf2(), wear_gain), 1).poles()).max() - 1.0

    assert scipy.optimize.brentq(radius, 1.2, 2.0) == pytest.approx(1.4505, abs=0.001)


@pytest.mark.parametrize(
    ('printed', 'ls_gain', 'crossover', 'phase', 'gain', 'complementary'),
    [(g_c1, -4.8, 7.08, 55.0, 12.97, 1.185), (g_c2, -0.012057, 3.79, 73.7, 27.04, 1.150)],
    ids=['ls2', 'ls7'],
)
def test_margins_of_g_c1_and_g_c2(printed, ls_gain, crossover, phase, gain, complementary):
    import control

    loop = driveline() * g_a() * printed(ls_gain)
    gain_margin, phase_margin, _, crossover_rad_s = control.margin(loop)
    assert phase_margin == pytest.approx(phase, abs=0.05)
    assert 20.0 * math.log10(gain_margin) == pytest.approx(gain, abs=0.01)
    assert crossover_rad_s == pytest.approx(crossover, abs=0.01)
    assert peaks(loop)[1] == pytest.approx(complementary, abs=0.001)


def test_steps_of_ls3_ls4_and_ls5():
    """LS3 overshoots by 28.8 %; LS4 and LS5 rise in .866 s and .766 s."""
    figures = [
        rise_and_overshoot(driveline() * g_a() * controller, 1e-3)
        for controller in (g_c1(-10.0), g_c2(-0.0060285), g_c2(-0.0072342))
    ]
    assert figures[0][1] == pytest.approx(28.8, abs=0.05)
    assert figures[1][0] == pytest.approx(0.866, abs=5e-4)
    assert figures[2][0] == pytest.approx(0.766, abs=5e-4)


def test_steps_of_hinf1_as_printed_and_with_2_14_times_its_gain():
    """They are 0.55 s and 12.5 %; Table 3.1 has the 0.30 s and 8 % of 2.14 times the gain."""
    as_printed = rise_and_overshoot(driveline() * g_a() * hinf1(), 1e-3)
    assert as_printed == pytest.approx((0.550, 12.5), abs=0.01)
    louder = rise_and_overshoot(driveline() * g_a() * hinf1() * 2.14, 1e-3)
    assert louder == pytest.approx((0.300, 7.29), abs=0.01)


@pytest.mark.slow
def test_worst_m_s_of_hinf1_by_trying_every_corner():
    """M_s is 3.38 over 128 corners, K_usura from 0.7 to 1.3 in steps of 0.01, 2000 frequencies."""
    import control

    z = np.exp(1j * np.geomspace(0.1, math.pi / DT, 2000) * DT)
    controller = (control.c2d(hinf1(), DT, 'zoh'))(z) / z
    highest = 0.0
    for plant in corner_plants():
        rates, vectors = np.linalg.eig(plant.A)
        parts = (plant.C @ vectors)[0] * np.linalg.solve(vectors, plant.B)[:, 0]
        loop = controller * (parts / (z[:, None] - rates)).sum(axis=1)
        for wear_gain in np.arange(0.7, 1.305, 0.01):
            highest = max(highest, (1.0 / np.abs(1.0 + wear_gain * loop)).max())
    assert highest == pytest.approx(3.38, abs=0.005)


def prototype(overshoot: float) -> tuple[float, float]:
    """Return zeta, and w_c over w_n of w_n^2 / (s (s + 2 zeta w_n))."""
    log = math.log(overshoot)
    zeta = -log / math.hypot(math.pi, log)
    return zeta, math.sqrt(math.sqrt(1.0 + 4.0 * zeta**4) - 2.0 * zeta**2)


def test_highest_crossover_by_arc_tangents():
    """
    It is 24.5 rad/s: delay, half the hold and the actuator's all-pass leave 14 % its margin.

    Delay and half the hold are 15 ms. The margin is atan(2 zeta w_n / w_c); a pair of zeros turns
    twice its own angle.
    """
    zeta, crossing = prototype(0.14)
    left = math.pi / 2.0 - math.atan2(2.0 * zeta, crossing)
    bound = scipy.optimize.brentq(
        lambda w: 0.015 * w + 2.0 * math.atan2(161.3 * w, 31340.0 - w**2) - left, 1.0, 100.0
    )
    assert bound == pytest.approx(24.5, abs=0.05)


def test_prototype_of_14_percent_by_its_closed_forms():
    """t_r w_c = 1.921 and w_c = 7.69 rad/s; -1/s lacks 67.9 degrees at 8 rad/s; asin(15/17)."""
    zeta, crossing = prototype(0.14)
    product = (math.pi - math.acos(zeta)) / math.sqrt(1.0 - zeta**2) * crossing
    assert product == pytest.approx(1.921, abs=5e-4)
    assert product / 0.25 == pytest.approx(7.69, abs=5e-3)
    margin = math.degrees(math.atan2(2.0 * zeta, crossing))
    value = complex((driveline() * g_a())(8j)) * -1.0 / 8j
    assert margin - math.degrees(np.angle(-value)) == pytest.approx(67.9, abs=0.05)
    assert math.degrees(math.asin(15.0 / 17.0)) == pytest.approx(61.93, abs=0.005)


def test_lag_of_the_actuator_at_rest_is_a_sum_over_its_factors():
    """It is 33.1 ms: b/c of each pole pair, less 1/138 and -161.3/31340 of its zeros."""
    lag = 82.23 / 2563 + 134.1 / 42700 - 1 / 138 + 161.3 / 31340
    assert lag == pytest.approx(0.0331, abs=5e-5)
