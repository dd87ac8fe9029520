# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The design with hold and delay in its plant: robust where designs without them are not."""

from dataclasses import replace

import numpy as np
import pytest

from ddct_controllers.design.analysis.loops import sampled_loop, sampled_plant
from ddct_controllers.design.analysis.margins import loop_margins
from ddct_controllers.design.analysis.worst_corner import (
    PlantCorners,
    WorstCorner,
    plant_corners,
    worst_corner,
)
from ddct_controllers.design.h_infinity.design import design_h_infinity
from ddct_controllers.design.h_infinity.problem import sampled_sensitivity
from ddct_controllers.design.h_infinity.recipes import make_weights
from ddct_controllers.design.h_infinity.synthesis.gamma_iteration import (
    synthesise,
)
from ddct_controllers.design.state_space import close_loop, frequency_response
from ddct_controllers.synthesised import SYNTHESISED, synthesised_design
from ddct_plant.linear.bilinear import from_w_plane, to_w_plane

pytestmark = pytest.mark.slow

HIGHEST_SENSITIVITY = 2.0
"""Highest M_s at the worst corner, required of at least one of our controllers."""


@pytest.fixture(scope='module')
def corners() -> PlantCorners:
    return plant_corners()


@pytest.fixture(scope='module')
def worst(corners: PlantCorners) -> dict[str, WorstCorner]:
    return {name: worst_corner(synthesised_design(name).sampled, corners) for name in SYNTHESISED}


def test_hinf_sampled_keeps_m_s_below_2_at_every_corner(worst, corners):
    """Wear is 0.7 to 1.3 and all 7 driveline parameters 20 % up and down: 128 corners."""
    assert len(corners.varied) == 7
    assert len(corners.plants) == 128
    assert worst['hinf_sampled'].unstable_corners == 0
    assert worst['hinf_sampled'].sensitivity_peak < HIGHEST_SENSITIVITY


@pytest.mark.parametrize('name', ['hinf_thesis', 'hinf_fitted'])
def test_designs_without_hold_and_delay_are_unstable_at_some_corners(worst, name):
    assert worst[name].unstable_corners > 10
    assert loop_margins(sampled_loop(synthesised_design(name).sampled)).stable


def test_without_the_weight_on_the_torque_some_corners_are_unstable(corners):
    """Hold and delay in the plant alone are not enough."""
    design = design_h_infinity(replace(make_weights('sampled'), effort=None))
    assert worst_corner(design.sampled, corners).unstable_corners > 10


def test_the_weight_on_the_torque_lets_the_driveline_alone():
    """
    hinf_sampled has no pole on the 2.93 Hz zeros of P_2; the design without the weight has.

    Distance of the nearest closed-loop pole to exp(s T), s the zero: above 0.05, below 0.005.
    """
    zero = np.exp(0.01 * np.roots([1.0, 5.344, 339.4])[0])
    with_it = synthesised_design('hinf_sampled').sampled
    without = design_h_infinity(replace(make_weights('sampled'), effort=None)).sampled
    distances = [
        np.abs(np.linalg.eigvals(close_loop(sampled_loop(c)).a) - zero).min()
        for c in (with_it, without)
    ]
    assert distances[0] > 0.05
    assert distances[1] < 0.005


def test_hold_and_delay_are_exactly_in_the_design_plant():
    """The w-plane plant at w = j tan(omega T/2) 2/T is the sampled one at omega; within 1e-9."""
    plant = sampled_plant()
    omega = np.geomspace(0.1, 300.0, 40)
    warped = 2.0 / 0.01 * np.tan(omega * 0.01 / 2.0)
    found = frequency_response(to_w_plane(plant), warped)
    assert found == pytest.approx(frequency_response(plant, omega), rel=1e-9)


def test_the_weighted_norm_of_the_sampled_loop_is_the_one_designed():
    """|[W_s S; W_t T; W_c K S]| swept over the unit circle, from 0.1 rad/s, is gamma to 0.1 %."""
    weights = make_weights('sampled')
    synthesis = design_h_infinity(weights).synthesis
    omega = np.geomspace(0.1, 314.0, 4000)
    warped = 200.0 * np.tan(omega * 0.005)
    plant = frequency_response(sampled_plant(), omega)
    controller = frequency_response(from_w_plane(synthesis.controller), omega)
    s = 1.0 / (1.0 + plant * controller)
    weighted = [
        weights.sensitivity.shifted().frequency_response(warped) * s,
        weights.complementary.rolled_off(10.0).frequency_response(warped)
        * (plant * controller * s),
        weights.effort.transfer_function().frequency_response(warped) * (controller * s),
    ]
    stack = np.sqrt(sum(np.abs(one) ** 2 for one in weighted))
    assert stack.max() == pytest.approx(synthesis.gamma, rel=1e-3)


def test_an_input_disturbance_is_an_input_of_the_problem():
    """It is one more input w; a disturbance of size zero does not change the norm of the rest."""
    weights = make_weights('sampled')
    parts = (
        to_w_plane(sampled_plant()),
        weights.sensitivity.shifted(),
        weights.complementary.rolled_off(10.0),
        weights.effort.transfer_function(),
    )
    without = sampled_sensitivity(*parts)
    small = sampled_sensitivity(*parts, disturbance_n_m=1e-9)
    assert small.b1.shape[1] == without.b1.shape[1] + 1
    controller = synthesise(without).controller
    # At each frequency: near the optimum the search for the peak ends 1e-5 away from it.
    omega = np.geomspace(1e-3, 1e4, 400)
    expected = largest_singular_values(without.close(controller), omega)
    found = largest_singular_values(small.close(controller), omega)
    assert found == pytest.approx(expected, rel=1e-6)


def largest_singular_values(system, omega):
    resolvent = 1j * omega[:, None, None] * np.eye(len(system.a)) - system.a
    inputs = np.broadcast_to(system.b, (omega.size, *system.b.shape))
    response = system.c @ np.linalg.solve(resolvent, inputs) + system.d
    return np.linalg.norm(response, 2, axis=(1, 2))


def test_an_input_disturbance_makes_the_worst_corner_worse_here(corners):
    """
    With 0.004 N m per rpm of reference beside the weight on the torque M_s rises.

    The weight already keeps the controller from cancelling the driveline's zeros, which would be
    the purpose of the disturbance.
    """
    weights = make_weights('sampled')
    problem = sampled_sensitivity(
        to_w_plane(sampled_plant()),
        weights.sensitivity.shifted(),
        weights.complementary.rolled_off(10.0),
        weights.effort.transfer_function(),
        disturbance_n_m=0.004,
    )
    found = from_w_plane(synthesise(problem, weights.back_off).controller)
    without = worst_corner(synthesised_design('hinf_sampled').sampled, corners).sensitivity_peak
    with_it = worst_corner(found, corners)
    assert with_it.unstable_corners or with_it.sensitivity_peak > without
