# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Cleaning by the rules of Section 3.2.2: on the thesis's own controller, and on bad ones."""

import numpy as np
import pytest

from ddct_controllers.design.h_infinity.cleaning import FAST_RAD_S, clean
from ddct_controllers.design.state_space import factors_text
from ddct_controllers.printed import H_INFINITY_CONTROLLERS
from ddct_plant.base.errors import DdctError
from ddct_plant.linear.lti import FactoredTransferFunction

RAW_ZEROS = (0.7567, 0.009368, 0.004946, (82.23, 2563.0), (121.4, 7696.0), (134.1, 4.27e4))
RAW_POLES = (1.418e5, 138.0, 89.52, 0.005905, (0.01896, 9.053e-5), (5.344, 339.4))
RAW = FactoredTransferFunction(-434.85, RAW_ZEROS, (*RAW_POLES, (146.2, 2.914e4)))
"""
Controller that `hinflmi` gave the thesis, with the pair of epsilon = 0.0095: 0.01896, 9.053e-5.
"""
NO_PAIR = FactoredTransferFunction(1.0, (0.001, 0.5), (0.5, 10.0, 20.0))


def test_the_thesis_controller_is_cleaned_to_hinf1():
    """It has the same poles and zeros; -434.85/1.418e5 = -0.003067, printed as -0.012266."""
    cleaned, steps = clean(RAW, 0.0095)
    printed = H_INFINITY_CONTROLLERS['hinf1']
    assert sorted(cleaned.numerator, key=str) == sorted(printed.numerator, key=str)
    assert sorted(cleaned.denominator, key=str) == sorted(printed.denominator, key=str)
    assert cleaned.gain == pytest.approx(-434.85 / 1.418e5)
    assert [step.rule.split(',')[0] for step in steps] == [
        'fast pole',
        'poles at -epsilon: one becomes s',
    ]


def test_the_printed_gain_of_hinf1_is_four_times_what_cleaning_leaves():
    """No rule gives the factor of 4.0, within 0.1 %: the printed gain is an erratum."""
    cleaned, _ = clean(RAW, 0.0095)
    assert H_INFINITY_CONTROLLERS['hinf1'].gain / cleaned.gain == pytest.approx(4.0, rel=1e-3)


def test_a_fast_pole_goes_by_its_gain_at_rest():
    """The factor (s + a) becomes a; epsilon's trace changes 2 % at 1 rad/s and less above."""
    cleaned, _ = clean(RAW, 0.0095)
    omega = np.geomspace(1.0, 100.0, 20)
    ratio = cleaned.frequency_response(omega) / RAW.frequency_response(omega)
    assert ratio == pytest.approx(1.0, abs=0.02)


def test_a_fast_zero_goes_too_and_a_slower_one_stays():
    zeros = (0.001, 0.5, 2.0 * FAST_RAD_S, 0.9 * FAST_RAD_S)
    raw = FactoredTransferFunction(3.0, zeros, (0.01, 0.01, 10.0, 20.0, 30.0))
    cleaned, steps = clean(raw, 0.01)
    assert cleaned.gain == pytest.approx(3.0 * 2.0 * FAST_RAD_S)
    assert cleaned.numerator == (0.5, 0.9 * FAST_RAD_S)
    assert steps[0].rule == 'fast zero, gain at rest kept'


def test_a_pair_within_a_thousandth_cancels_and_one_beyond_does_not():
    zeros = (0.001, 5.0, 7.0, (2.0, 100.0), (3.0, 400.0))
    poles = (0.01, 0.01, 5.004, 7.01, (2.0001, 100.01), (3.3, 400.0))
    cleaned, steps = clean(FactoredTransferFunction(1.0, zeros, poles), 0.01)
    assert cleaned.numerator == (7.0, (3.0, 400.0))
    assert cleaned.denominator == (0.0, 7.01, (3.3, 400.0))
    assert [step.rule for step in steps[1:]] == ['pair that cancels'] * 2


@pytest.mark.parametrize(
    ('raw', 'complaint'),
    [
        (NO_PAIR, r'no two poles near epsilon = 0.01 rad/s'),
        (
            FactoredTransferFunction(1.0, ((1e-4, 1e-6),), (0.01, 0.01, 10.0)),
            'the slowest zero of the controller is not real',
        ),
    ],
)
def test_a_controller_that_no_rule_fits_is_an_error(raw, complaint):
    with pytest.raises(DdctError, match=complaint):
        clean(raw, 0.01)


def test_factors_read_as_the_thesis_prints_them():
    assert factors_text([0.0]) == 's'
    assert factors_text([89.52]) == '(s + 89.52)'
    assert factors_text([(-1.915, 0.948)], 'z') == '(z^2 - 1.915 z + 0.948)'
    assert factors_text([-0.99993], 'z', 5) == '(z - 0.99993)'
