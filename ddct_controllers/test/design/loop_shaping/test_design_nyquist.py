# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The Nyquist count agrees with the closed loop's poles, on the imaginary axis or not."""

import itertools

import pytest
from nyquist_contour import unstable_by_contour
from refusals import refused
from samples import sampled

from ddct_controllers.design.analysis.loops import ContinuousLoop, continuous_loop, plant_in_rpm
from ddct_controllers.design.analysis.margins import unstable_poles
from ddct_controllers.design.analysis.nyquist import NyquistCount, nyquist_count
from ddct_controllers.design.loop_shaping.design import (
    integrators,
    network_steps,
    stabilising_sign,
)
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.linear.lti import FactoredTransferFunction


@pytest.mark.parametrize(('gain', 'unstable'), [(1.0, 1), (-1.0, 2)])
def test_k_c_of_1_gives_one_unstable_pole_and_minus_1_gives_two(gain, unstable):
    """Section 2.2.1, with both poles of L at 0 passed on the right."""
    loop = continuous_loop(integrators(gain, 1))
    assert nyquist_count(loop) == NyquistCount(open_loop_unstable=0, encirclements=unstable)
    assert unstable_poles(loop) == unstable


@pytest.mark.parametrize(
    ('name', 'delay_s'),
    sampled(itertools.product(sorted(PRINTED_CONTROLLERS), [0.0, 0.01, 0.3]), every=2),
)
def test_every_printed_loop_has_as_many_unstable_poles_as_the_criterion_counts(name, delay_s):
    """The product counts without dead time; with one, our contour does."""
    loop = continuous_loop(PRINTED_CONTROLLERS[name], delay_s=delay_s)
    assert unstable_by_contour(loop) == unstable_poles(loop)
    if not delay_s:
        assert nyquist_count(loop).closed_loop_unstable == unstable_poles(loop)


def test_some_of_those_loops_are_unstable():
    """With 0.3 s of delay LS9 has two unstable poles, so the comparison above can fail."""
    loop = continuous_loop(PRINTED_CONTROLLERS['ls9'], delay_s=0.3)
    assert unstable_by_contour(loop) == 2


GAINS = [-20.0, -1.0, -0.1, 0.1, 1.0, 20.0]
DENOMINATORS = [
    (0.0, 0.0, 1.0),
    ((0.0, 4.0), 1.0),
    (0.0, (0.0, 4.0), 3.0),
    ((0.0, 4.0), (0.0, 90.0), 1.0),
    (-1.0, 2.0, 5.0),
    (0.0, (-0.2, 9.0), 40.0),
]


@pytest.mark.parametrize(
    ('denominator', 'gain'), sampled(itertools.product(DENOMINATORS, GAINS), every=5)
)
def test_poles_on_the_axis_and_unstable_poles_are_counted_right(gain, denominator):
    loop = ContinuousLoop(FactoredTransferFunction(gain, (0.7,), denominator))
    count = nyquist_count(loop)
    assert count.closed_loop_unstable == unstable_poles(loop) == unstable_by_contour(loop)


def test_the_sign_of_k_c_must_be_negative():
    """With the other sign P_cl is odd whatever the networks, so no network can mend it."""
    assert stabilising_sign(plant_in_rpm(), 1) == -1
    assert stabilising_sign(plant_in_rpm(), 0) == -1
    for step in network_steps().values():
        flipped = FactoredTransferFunction(-1.0) * step
        assert nyquist_count(continuous_loop(flipped)).closed_loop_unstable % 2 == 1


def test_a_curve_through_the_critical_point_is_named():
    """L = 2/(s (s+1)^2): -1 at w = 1."""
    loop = ContinuousLoop(FactoredTransferFunction(2.0, (), (0.0, 1.0, 1.0)))
    with pytest.raises(DdctError, match='passes through -1'):
        nyquist_count(loop)


def test_a_loop_that_is_not_strictly_proper_is_refused():
    loop = ContinuousLoop(FactoredTransferFunction(2.0, (1.0,), (2.0,)))
    with pytest.raises(ParameterError, match='more poles than zeros'):
        nyquist_count(loop)


def test_a_loop_with_dead_time_is_refused():
    with refused(ParameterError, 'delay'):
        nyquist_count(continuous_loop(PRINTED_CONTROLLERS['ls8'], delay_s=0.01))
