# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Weights of Section 3.2.1: their numbers, and parameters that make no weight."""

import math

import numpy as np
import pytest
from refusals import refused

from ddct_controllers.design.analysis.loops import plant_in_rpm
from ddct_controllers.design.h_infinity.recipes import THESIS_SPECIFICATIONS, make_weights
from ddct_controllers.design.h_infinity.uncertainty import (
    OMEGA,
    PRINTED_W_U,
    fit_first_order,
    relative_error,
    shortfall_from_rad_s,
    wear_family,
)
from ddct_controllers.design.h_infinity.weights import (
    ComplementaryWeight,
    EffortWeight,
    SensitivityWeight,
    stable_weight,
)
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_plant.base.errors import ParameterError
from ddct_plant.linear.lti import FactoredTransferFunction

SLOW, FAST = np.array([1e-6]), np.array([1e6])


def test_the_thesis_specifications_give_its_weights():
    """S_p 1.33, T_p 1.02, w_1 2.98 and w_2 28 are as printed."""
    weights = make_weights('thesis')
    assert weights.sensitivity.peak == pytest.approx(1.33, abs=0.005)
    assert weights.complementary.peak == pytest.approx(1.02, abs=0.005)
    assert weights.sensitivity.corner_rad_s == pytest.approx(2.98, abs=0.005)
    assert weights.complementary.corner_rad_s == 28.0


def test_the_inverse_of_w_s_is_k_s_squared_at_first_and_s_p_at_last():
    inverse = 1.0 / SensitivityWeight(0.15, 1.33).transfer_function().frequency_response(
        np.concatenate([SLOW, FAST])
    )
    assert inverse[0] == pytest.approx(-0.15 * SLOW[0] ** 2, rel=1e-5)
    assert abs(inverse[1]) == pytest.approx(1.33, rel=1e-5)


def test_w_s_has_two_poles_at_zero_where_the_text_has_one():
    weight = SensitivityWeight(0.15, 1.33)
    assert np.count_nonzero(weight.transfer_function().poles == 0.0) == 2
    assert weight.shifted().poles == pytest.approx([-weight.offset_rad_s] * 2)


def test_epsilon_changes_w_s_only_far_below_the_crossover():
    """W_s changes by less than 1 % from 1 rad/s on."""
    weight = SensitivityWeight(0.15, 1.33)
    omega = np.geomspace(1.0, 1e3, 30)
    ratio = weight.shifted().frequency_response(omega)
    ratio = ratio / weight.transfer_function().frequency_response(omega)
    assert np.abs(ratio) == pytest.approx(1.0, abs=0.01)


def test_the_inverse_of_w_t_is_t_p_at_rest_and_3_db_lower_at_w_2():
    """It is 3 dB lower with the Butterworth polynomial, 6 dB with the double zero of `sderiv`."""
    for damping, fall in ((math.sqrt(0.5), math.sqrt(2.0)), (1.0, 2.0)):
        weight = ComplementaryWeight(1.02, 28.0, damping).transfer_function()
        at_rest, at_corner = 1.0 / np.abs(weight.frequency_response(np.array([1e-9, 28.0])))
        assert at_rest == pytest.approx(1.02)
        assert at_corner == pytest.approx(1.02 / fall)


def test_a_longer_rise_time_slows_every_weight_alike():
    """When time scales by 2, K does by 4, all corners and the torque per rpm by 1/2."""
    fast = make_weights('sampled')
    slow = make_weights('sampled', TimeSpecifications(0.6, 0.08))
    assert slow.sensitivity.low_frequency_gain == 4.0 * fast.sensitivity.low_frequency_gain
    assert slow.sensitivity.corner_rad_s == pytest.approx(fast.sensitivity.corner_rad_s / 2.0)
    assert slow.complementary.corner_rad_s == fast.complementary.corner_rad_s / 2.0
    assert slow.effort.corner_rad_s == fast.effort.corner_rad_s / 2.0
    assert slow.effort.torque_n_m_per_rpm == fast.effort.torque_n_m_per_rpm / 2.0


def test_the_effort_weight_costs_1_at_its_torque_and_rises_a_hundredfold_from_its_corner():
    """Compared by hand at 0, w_c, 100 w_c and infinity: (1 + s/w_c)/(1 + s/(100 w_c))/u_max."""
    weight = EffortWeight(torque_n_m_per_rpm=0.05, corner_rad_s=30.0).transfer_function()
    found = np.abs(weight.frequency_response(np.array([0.0, 30.0, 3000.0, 1e12])))
    by_hand = [20.0, 20.0 * math.sqrt(2.0 / 1.0001), 20.0 * math.sqrt(10001.0 / 2.0), 2000.0]
    assert found == pytest.approx(by_hand, rel=1e-9)


def test_arguments_override_the_recipe():
    weights = make_weights('sampled', THESIS_SPECIFICATIONS, 0.2, 30.0, 0.1, 1.05)
    assert weights.sensitivity.low_frequency_gain == 0.2
    assert weights.complementary.corner_rad_s == 30.0
    assert weights.effort.torque_n_m_per_rpm == 0.1
    assert weights.back_off == 1.05


def test_wear_makes_a_relative_error_of_0_3_at_every_frequency():
    error = relative_error(plant_in_rpm(), wear_family(), OMEGA)
    assert error == pytest.approx(0.3, rel=1e-12)


def test_the_fitted_w_u_of_a_constant_error_is_that_constant():
    weight = fit_first_order(OMEGA, np.full_like(OMEGA, 0.3))
    assert np.abs(weight.frequency_response(OMEGA)) == pytest.approx(0.3, rel=1e-6)


def test_a_first_order_error_is_its_own_fit():
    """0.2 (1 + s/2)/(1 + s/50), whose pole is not on the grid of the fit, agrees within 1 %."""
    error = np.abs(FactoredTransferFunction(5.0, (2.0,), (50.0,)).frequency_response(OMEGA))
    found = np.abs(fit_first_order(OMEGA, error).frequency_response(OMEGA))
    assert np.all(found >= error * (1.0 - 1e-9))
    assert found == pytest.approx(error, rel=0.02)


def test_the_printed_w_u_falls_short_by_0_4_percent():
    """It does so from 6.3e3 rad/s on, before the 1.3e4 rad/s of its pole."""
    short = 1.0 - np.abs(PRINTED_W_U.frequency_response(FAST))[0] / 0.3
    assert short == pytest.approx(0.0043, abs=1e-4)
    assert shortfall_from_rad_s(PRINTED_W_U, 0.3) == pytest.approx(6.34e3, rel=0.01)
    assert shortfall_from_rad_s(FactoredTransferFunction(0.31), 0.3) is None
    assert shortfall_from_rad_s(FactoredTransferFunction(0.29), 0.3) == 0.0


@pytest.mark.parametrize(
    ('build', 'complaint'),
    [
        (lambda: SensitivityWeight(0.0, 1.33), 'K, the low-frequency gain of S, is 0'),
        (lambda: SensitivityWeight(0.15, 0.9), r'S_p.* is 0.9: it must be above 1: .*Bode'),
        (lambda: SensitivityWeight(math.nan, 1.33), 'give a finite number'),
        (lambda: ComplementaryWeight(0.9, 28.0), r'T_p.* at least 1: with an integrator'),
        (lambda: ComplementaryWeight(1.02, -28.0), 'w_2 is -28: it must be above 0'),
        (lambda: EffortWeight(0.0, 30.0), 'the torque of the effort weight is 0'),
        (
            lambda: stable_weight('W_1', FactoredTransferFunction(1.0, (1.0, 2.0), (3.0,))),
            'W_1 has 2 zeros and 1 poles: make it proper',
        ),
        (
            lambda: stable_weight('W_1', SensitivityWeight(0.15, 1.33).transfer_function()),
            r'W_1 has a pole at .*0.* replace s by s \+ epsilon',
        ),
        (
            lambda: stable_weight('W_2', FactoredTransferFunction(1.0, (), (-2.0,))),
            'W_2 has a pole at 2.*reflect the pole',
        ),
        (lambda: make_weights('thesis', effort_n_m_per_rpm=0.1), 'only the sampled design'),
    ],
)
def test_a_weight_that_cannot_be_used_is_named(build, complaint):
    with pytest.raises(ParameterError, match=complaint):
        build()


def test_an_unknown_recipe_lists_the_known_ones():
    with refused(ParameterError, key='weights'):
        make_weights('guessed')
