# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every descent starts at its start, ends at zero, and has the rate of its values."""

import math

import pytest

from ddct_reference.descent import CrfRamp, TimedDescent

DESCENTS = {
    'ramp': CrfRamp(50.0),
    'tanh': TimedDescent(0.8, 'tanh'),
    'polynomial': TimedDescent(0.8, 'polynomial'),
}
"""Descents by name; each takes 0.8 s from 40 rad/s."""
INSIDE = [0.8 * share for share in (0.01, 0.2, 0.5, 0.77, 0.99)]

each = pytest.mark.parametrize('descent', DESCENTS.values(), ids=DESCENTS)


@each
@pytest.mark.parametrize('start', [40.0, -40.0])
def test_it_starts_exactly_at_its_start_and_stays_exactly_at_zero(descent, start):
    assert descent.at(start, 0.0)[0] == start
    for time_s in (0.8, 0.81, 5.0):
        assert descent.at(start, time_s) == (0.0, 0.0)


@each
def test_it_falls_all_the_way(descent):
    found = [descent.at(40.0, time_s)[0] for time_s in [0.0, *INSIDE, 0.8]]
    assert found == sorted(found, reverse=True)
    assert len(set(found)) == len(found)


@each
@pytest.mark.parametrize('time_s', INSIDE)
def test_its_rate_is_the_derivative_of_its_value(descent, time_s):
    step = 1e-6
    difference = descent.at(40.0, time_s + step)[0] - descent.at(40.0, time_s - step)[0]
    assert descent.at(40.0, time_s)[1] == pytest.approx(difference / (2 * step), rel=1e-6)


@each
def test_it_is_odd_in_its_start(descent):
    for time_s in INSIDE:
        value, rate = descent.at(40.0, time_s)
        assert descent.at(-40.0, time_s) == (-value, -rate)


def test_the_tanh_ends_with_three_percent_of_its_mean_slope():
    mean = 40.0 / 0.8
    ends = [-DESCENTS['tanh'].at(40.0, time_s)[1] for time_s in (0.0, math.nextafter(0.8, 0.0))]
    assert ends == pytest.approx([0.03 * mean] * 2, rel=0.02)


def test_the_polynomial_ends_without_any_slope():
    for time_s in (0.0, math.nextafter(0.8, 0.0)):
        assert DESCENTS['polynomial'].at(40.0, time_s)[1] == pytest.approx(0.0, abs=1e-10)


def test_only_the_polynomial_lets_both_plates_accelerate_alike_when_the_clutch_locks():
    at_lock = {name: abs(each.at(40.0, 0.8 - 1e-9)[1]) for name, each in DESCENTS.items()}
    assert at_lock['polynomial'] < 1e-5 < 1.0 < min(at_lock['ramp'], at_lock['tanh'])
