# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Time specifications become the thesis's numbers, and those that make no sense are named."""

import math

import numpy as np
import pytest
import scipy
from refusals import refused

from ddct_controllers.design.analysis.loops import ContinuousLoop
from ddct_controllers.design.analysis.margins import loop_margins
from ddct_controllers.design.analysis.step_response import overshoot, rise_time_s, step_response
from ddct_controllers.design.loop_shaping.specifications import (
    TimeSpecifications,
    highest_crossover_rad_s,
    prototype_phase_margin,
    require_reachable,
    rise_time_crossover_product,
    unavoidable_lag,
)
from ddct_plant.base.errors import ParameterError
from ddct_plant.linear.lti import FactoredTransferFunction
from ddct_plant.models.printed import ACTUATOR

CHAPTER_2 = TimeSpecifications(rise_time_s=0.25, overshoot=0.14)
CHAPTER_3 = TimeSpecifications(rise_time_s=0.3, overshoot=0.08)


def prototype(damping: float) -> ContinuousLoop:
    """Return L = 1/(s (s + 2 zeta)), w_n = 1."""
    return ContinuousLoop(FactoredTransferFunction(1.0, (), (0.0, 2.0 * damping)))


@pytest.mark.parametrize(
    ('computed', 'printed', 'tolerance'),
    [
        (CHAPTER_2.damping, 0.5305, 5e-5),
        (CHAPTER_2.sensitivity_peak, 1.427, 5e-4),
        (CHAPTER_2.complementary_peak, 1.112, 5e-4),
        (CHAPTER_3.damping, 0.627, 5e-4),
        (CHAPTER_3.sensitivity_peak, 1.33, 5e-3),
        (CHAPTER_3.complementary_peak, 1.024, 5e-4),
        (CHAPTER_3.natural_frequency_rad_s, 9.61, 5e-3),
    ],
)
def test_the_thesis_translations_come_out(computed, printed, tolerance):
    assert computed == pytest.approx(printed, abs=tolerance)


@pytest.mark.parametrize('damping', [0.2, 0.5305, 0.63, 0.69])
def test_the_formulas_are_those_of_the_prototype(damping):
    """Margins and step response of the prototype are computed here without the formulas."""
    loop = prototype(damping)
    margins = loop_margins(loop)
    time, output = step_response(loop, 40.0)
    expected = math.exp(-math.pi * damping / math.sqrt(1.0 - damping**2))
    assert overshoot(time, output) == pytest.approx(expected, rel=1e-5)
    specifications = TimeSpecifications(1.0, expected)
    assert specifications.damping == pytest.approx(damping, rel=1e-12)
    assert specifications.sensitivity_peak == pytest.approx(margins.sensitivity_peak, rel=1e-8)
    assert specifications.complementary_peak == pytest.approx(margins.complementary_peak, rel=1e-8)
    assert math.degrees(prototype_phase_margin(damping)) == pytest.approx(
        margins.phase_margin_deg, abs=1e-6
    )
    assert rise_time_crossover_product(damping) == pytest.approx(
        rise_time_s(time, output) * margins.crossover_rad_s, rel=1e-5
    )


def test_t_r_w_c_of_2_02_belongs_to_a_damping_of_0_63_and_not_to_14_percent():
    damping = scipy.optimize.brentq(lambda x: rise_time_crossover_product(x) - 2.02, 0.3, 0.9)
    assert damping == pytest.approx(0.633, abs=5e-4)
    assert rise_time_crossover_product(CHAPTER_2.damping) == pytest.approx(1.921, abs=5e-4)
    assert CHAPTER_2.crossover_rad_s == pytest.approx(7.69, abs=5e-3)


def test_a_well_damped_prototype_has_no_peak_of_t():
    specifications = TimeSpecifications(1.0, overshoot=0.015)
    assert specifications.damping == pytest.approx(0.8, abs=0.001)
    assert specifications.complementary_peak == 1.0


@pytest.mark.parametrize(
    ('rise_time', 'specified_overshoot', 'key'),
    [
        (-0.1, 0.14, 'rise time'),
        (0.0, 0.14, 'rise time'),
        (20.0, 0.14, 'rise time'),
        (math.nan, 0.14, 'rise time'),
        (0.25, 0.0, 'overshoot'),
        (0.25, -0.1, 'overshoot'),
        (0.25, 1.0, 'overshoot'),
        (0.25, math.inf, 'overshoot'),
        (0.25, '14', 'overshoot'),
    ],
)
def test_specifications_without_sense_are_named(rise_time, specified_overshoot, key):
    with refused(ParameterError, key=key):
        TimeSpecifications(rise_time, specified_overshoot)


def test_the_unavoidable_lag_is_that_of_delay_hold_and_the_right_half_plane_zeros():
    """15 ms of delay and half hold, and all that G_a turns beyond its minimum-phase twin."""
    omega = np.array([20.0])
    mirrored = tuple(
        (abs(factor[0]), factor[1]) if isinstance(factor, tuple) else factor
        for factor in ACTUATOR.numerator
    )
    twin = FactoredTransferFunction(ACTUATOR.gain, mirrored, ACTUATOR.denominator)
    turned = np.angle(twin.frequency_response(omega) / ACTUATOR.frequency_response(omega))[0]
    assert unavoidable_lag(20.0) == pytest.approx(0.015 * 20.0 + turned, rel=1e-12)


def test_less_overshoot_allows_less_crossover():
    dampings = np.linspace(0.1, 0.9, 9)
    bounds = [highest_crossover_rad_s(damping) for damping in dampings]
    assert all(np.diff(bounds) < 0.0)
    assert highest_crossover_rad_s(CHAPTER_2.damping) == pytest.approx(24.5, abs=0.1)


def test_a_crossover_above_the_bound_is_refused_with_the_bound_and_a_way_out():
    with refused(ParameterError, 'rise time'):
        require_reachable(TimeSpecifications(rise_time_s=0.05, overshoot=0.14))
    require_reachable(CHAPTER_2)
