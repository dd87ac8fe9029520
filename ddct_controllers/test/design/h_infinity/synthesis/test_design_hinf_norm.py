# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The norm that accepts or refuses every controller, against closed forms and sweeps."""

import math

import numpy as np
import pytest

from ddct_controllers.design.analysis.loops import sampled_plant
from ddct_controllers.design.h_infinity.synthesis.gamma_iteration import h_infinity_norm
from ddct_plant.base.errors import ParameterError
from ddct_plant.linear.bilinear import from_w_plane, to_w_plane
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace


def norm_of(*factors) -> float:
    return h_infinity_norm(FactoredTransferFunction(*factors).to_state_space())


@pytest.mark.parametrize('damping', [0.5, 0.1, 1e-3, 1e-5])
def test_a_resonance_has_its_peak(damping):
    """1/(s^2 + 2 zeta s + 1): 1 / (2 zeta sqrt(1 - zeta^2)), within 1e-6."""
    peak = 1.0 / (2.0 * damping * math.sqrt(1.0 - damping**2))
    assert norm_of(1.0, (), ((2.0 * damping, 1.0),)) == pytest.approx(peak, rel=1e-6)


def test_the_higher_of_two_distant_peaks_is_found():
    """One is broad, 3 at 1 rad/s, the other sharp, 5 at 1000 rad/s."""
    broad = FactoredTransferFunction(3.0, (0.0,), ((1.0, 1.0),))
    sharp = FactoredTransferFunction(5.0, (0.0,), ((1.0, 1e6),))
    one, two = broad.to_state_space(), sharp.to_state_space()
    a = np.block([[one.a, np.zeros((2, 2))], [np.zeros((2, 2)), two.a]])
    both = StateSpace(a, np.vstack([one.b, two.b]), np.hstack([one.c, two.c]), one.d + two.d)
    omega = np.linspace(999.0, 1001.0, 20001)
    swept = np.abs(broad.frequency_response(omega) + sharp.frequency_response(omega)).max()
    assert h_infinity_norm(both) == pytest.approx(swept, rel=1e-6)


def test_a_high_pass_has_its_peak_at_infinity_and_a_low_pass_at_rest():
    assert norm_of(2.0, (0.0,), (3.0,)) == pytest.approx(2.0)
    assert norm_of(2.0, (), (4.0,)) == pytest.approx(0.5)


def test_a_constant_and_nothing():
    static = StateSpace(
        np.zeros((0, 0)), np.zeros((0, 2)), np.zeros((1, 0)), np.array([[3.0, 4.0]])
    )
    assert h_infinity_norm(static) == pytest.approx(5.0)
    assert norm_of(0.0, (), (1.0,)) == 0.0


@pytest.mark.parametrize('pole', [-1.0, 0.0])
def test_a_loop_that_is_not_stable_has_no_norm(pole):
    assert norm_of(1.0, (), (pole,)) == math.inf


def test_the_bilinear_transform_keeps_the_norm():
    """The norm of a sampled system over the unit circle is found by a fine sweep."""
    a, b = np.array([[0.9, 0.2], [-0.3, 0.8]]), np.array([[1.0], [0.5]])
    system = StateSpace(a, b, np.array([[1.0, 0.0]]), np.array([[0.2]]), 0.01)
    z = np.exp(1j * np.linspace(0.0, math.pi, 100001)).reshape(-1, 1, 1)
    values = system.c @ np.linalg.solve(z * np.eye(2) - system.a, system.b[None]) + system.d
    assert h_infinity_norm(to_w_plane(system)) == pytest.approx(np.abs(values).max(), rel=1e-7)


def test_the_way_to_the_w_plane_and_back_changes_nothing():
    """The plant has hold and delay, a pole at z = 0; each entry agrees within 1e-9."""
    plant = sampled_plant()
    back = from_w_plane(to_w_plane(plant))
    for name in 'abcd':
        expected = getattr(plant, name)
        scale = max(np.abs(expected).max(), 1.0)
        assert getattr(back, name) == pytest.approx(expected, abs=1e-9 * scale)


def test_a_continuous_system_has_no_w_plane():
    with pytest.raises(ParameterError, match='discretise it first'):
        to_w_plane(FactoredTransferFunction(1.0, (), (1.0,)).to_state_space())
