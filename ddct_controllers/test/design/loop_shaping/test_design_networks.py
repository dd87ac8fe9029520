# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Lead and lag networks of Section 2.2.2."""

import math

import numpy as np
import pytest
from refusals import refused

from ddct_controllers.design.analysis.loops import plant_in_rpm
from ddct_controllers.design.loop_shaping.design import (
    lag_network,
    lead_network,
    with_crossover,
)
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.base.errors import ParameterError

OMEGA = np.geomspace(1e-2, 1e3, 20001)
HIGHEST_PHASE = math.asin(15.0 / 17.0)
"""Phase arcsin((m - 1)/(m + 1)) in rad for m = 16, at sqrt(m) times the corner."""


def test_m_d_of_16_gives_about_40_degrees_at_the_normalised_frequency_1():
    """It is arctan 1 - arctan 1/16; the thesis reads 40 off its figure."""
    lead = lead_network(zero_rad_s=8.0, ratio=16.0)
    phase = float(np.angle(lead.frequency_response(8.0)))
    assert phase == pytest.approx(math.atan(1.0) - math.atan(1.0 / 16.0), rel=1e-12)
    assert math.degrees(phase) == pytest.approx(45.0 - 3.576, abs=1e-3)


def test_a_lead_has_the_response_of_its_formula():
    lead = lead_network(zero_rad_s=2.0, ratio=16.0)
    response = lead.frequency_response(OMEGA)
    expected = (1.0 + 1j * OMEGA / 2.0) / (1.0 + 1j * OMEGA / 32.0)
    np.testing.assert_allclose(response, expected, rtol=1e-12)
    assert np.angle(response).max() == pytest.approx(HIGHEST_PHASE, abs=1e-7)
    assert OMEGA[np.angle(response).argmax()] == pytest.approx(2.0 * 4.0, rel=1e-3)


def test_a_lag_attenuates_by_its_ratio_and_delays_by_its_lowest_phase():
    lag = lag_network(pole_rad_s=0.6, ratio=16.0)
    response = lag.frequency_response(OMEGA)
    expected = (1.0 + 1j * OMEGA / 9.6) / (1.0 + 1j * OMEGA / 0.6)
    np.testing.assert_allclose(response, expected, rtol=1e-12)
    assert np.angle(response).min() == pytest.approx(-HIGHEST_PHASE, abs=1e-7)
    assert abs(response[-1]) == pytest.approx(1.0 / 16.0, rel=1e-3)
    assert np.angle(lag.frequency_response(3.0)) == pytest.approx(
        math.atan(5.0 / 16.0) - math.atan(5.0)
    )


def test_the_ratio_of_a_network_may_be_a_little_above_one():
    gains = [network(1.0, 1.25).frequency_response(1e6) for network in (lead_network, lag_network)]
    assert np.abs(gains) == pytest.approx([1.25, 0.8], rel=1e-9)


def test_the_gain_for_a_crossover_keeps_sign_zeros_and_poles():
    shape, plant = PRINTED_CONTROLLERS['ls7'], plant_in_rpm()
    changed = with_crossover(shape, plant, 3.5)
    loop = (changed * plant).frequency_response(np.array([3.5]))
    assert abs(loop[0]) == pytest.approx(1.0, rel=1e-12)
    assert changed.gain < 0.0
    assert (changed.numerator, changed.denominator) == (shape.numerator, shape.denominator)


@pytest.mark.parametrize(
    ('corner', 'ratio', 'lead', 'lag'),
    [(0.0, 16.0, 'z_d', 'p_i'), (1.0, 1.0, 'm_d', 'm_i'), (-2.0, 4.0, 'z_d', 'p_i')],
)
def test_networks_that_are_none_are_refused(corner, ratio, lead, lag):
    with refused(ParameterError, f'lead network: {lead}'):
        lead_network(corner, ratio)
    with refused(ParameterError, f'lag network: {lag}'):
        lag_network(corner, ratio)
