# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The plan of `least_jerk` beside linear programs and integrations of its own equations."""

import math

import numpy as np
import pytest
import scipy

from ddct_controllers.least_jerk.plan import SHORTEST_S, falling_rate, final_surplus, least_rate

STEPS = 400


def rate_of_a_program(momentum, surplus, time_s):
    """Return the least largest |dy/dt| of piecewise constant rates that reach zero together."""
    step = time_s / STEPS
    # y_k = y_0 + step sum u; the integral of y over the steps, by the trapezium rule.
    ends = np.append(np.full(STEPS, step), 0.0)
    areas = np.append(step * step * (STEPS - np.arange(STEPS) - 0.5), 0.0)
    limits = np.vstack(
        [np.hstack([sign * np.eye(STEPS), np.full((STEPS, 1), -1.0)]) for sign in (1.0, -1.0)]
    )
    found = scipy.optimize.linprog(
        np.append(np.zeros(STEPS), 1.0),
        A_ub=limits,
        b_ub=np.zeros(2 * STEPS),
        A_eq=np.vstack([ends, areas]),
        b_eq=[-surplus, momentum - surplus * time_s],
        bounds=[(None, None)] * (STEPS + 1),
    )
    return found.x[-1]


@pytest.mark.parametrize(
    ('momentum', 'surplus', 'time_s'), [(20.0, 0.0, 1.0), (20.0, -30.0, 0.8), (11.4, 12.0, 0.5)]
)
def test_no_request_has_a_smaller_rate(momentum, surplus, time_s):
    least = least_rate(momentum, surplus, time_s)
    assert least == pytest.approx(rate_of_a_program(momentum, surplus, time_s), rel=1e-3)


def test_a_time_that_has_passed_is_the_shortest_one():
    assert least_rate(5.0, 1.0, -1.0) == least_rate(5.0, 1.0, SHORTEST_S)


@pytest.mark.parametrize(('momentum', 'surplus'), [(20.0, 0.0), (11.4, 12.0)])
@pytest.mark.parametrize('faster', [1.5, 4.0, 30.0])
def test_a_fall_after_a_faster_rise_ends_slip_and_surplus_together(momentum, surplus, faster):
    time_s, steps = 0.9, 90_000
    rising = faster * least_rate(momentum, surplus, time_s)
    falling = falling_rate(momentum, surplus, time_s, rising)
    # It rises until what is left of the time is what the fall takes.
    rise_s = (falling * time_s - surplus) / (rising + falling)
    times = (np.arange(steps) + 0.5) * time_s / steps
    y = surplus + np.where(
        times < rise_s, rising * times, rising * rise_s - falling * (times - rise_s)
    )
    assert y[-1] == pytest.approx(0.0, abs=0.01)
    assert y.mean() * time_s == pytest.approx(momentum, rel=1e-4)
    assert falling < least_rate(momentum, surplus, time_s)


@pytest.mark.parametrize(
    ('surplus', 'rising'), [(0.0, 0.0), (0.0, 80.0), (-10.0, 1e4), (200.0, 1e4)]
)
def test_the_rise_is_no_slower_than_the_fall_and_none_where_too_much_torque_is_there(
    surplus, rising
):
    assert falling_rate(20.0, surplus, 0.9, rising) == least_rate(20.0, surplus, 0.9)


@pytest.mark.parametrize(('end', 'band'), [(3.0, 9.0), (20.0, 9.0), (0.0, 5.0)])
def test_the_way_down_ends_at_the_wanted_surplus_without_exceeding_the_rate(end, band):
    rate, step, momentum = 120.0, 1e-4, 8.0
    surplus = [final_surplus(momentum, rate, band, end)]
    for _ in range(40000):
        momentum -= step * surplus[-1]
        if momentum < 1e-6:
            break
        surplus.append(final_surplus(momentum, rate, band, end))
    rates = np.diff(surplus) / step
    assert np.abs(rates).max() == pytest.approx(rate, rel=2e-3)
    assert rates.max() <= 0.0
    assert surplus[-1] == pytest.approx(end, abs=0.05)


def test_line_and_curve_meet_with_the_same_slope():
    rate, band, end, step = 100.0, 8.0, 2.0, 1e-6
    corner = (rate / band - end) / band
    below, at, above = (
        final_surplus(corner + change, rate, band, end) for change in (-step, 0.0, step)
    )
    assert at == pytest.approx(rate / band)
    assert (above - at) / step == pytest.approx((at - below) / step, rel=1e-4)
    assert math.isclose((at - below) / step, band, rel_tol=1e-6)
