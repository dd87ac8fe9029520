# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""No corner, wear gain of the range, or point inside the corners is worse than the worst one."""

import itertools
from functools import cache
from types import SimpleNamespace
from typing import Any

import control
import numpy as np
import pytest

from ddct_controllers.design.analysis.driveline_mode import locked_driveline_zero
from ddct_controllers.design.analysis.loops import IDENTIFIED_DRIVELINE, sampled_loop
from ddct_controllers.design.analysis.margins import closed_loop_stable, loop_margins
from ddct_controllers.design.analysis.worst_corner import (
    PARAMETER_SPREAD,
    WEAR_GAINS,
    PlantCorners,
    WorstCorner,
    plant_corners,
    worst_corner,
)
from ddct_controllers.design.state_space import frequency_response, scaled
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.actuator import ActuatorParameters

pytestmark = pytest.mark.slow


@pytest.fixture(scope='module')
def corners() -> PlantCorners:
    return plant_corners()


def sampled(name: str) -> StateSpace:
    return discretise_zoh(PRINTED_CONTROLLERS[name].to_state_space(), PERIOD_S)


@cache
def worst_of(name: str) -> WorstCorner:
    return worst_corner(sampled(name), plant_corners())


def test_there_is_a_corner_for_every_combination_of_the_seven_parameters(corners):
    assert len(corners.plants) == 2**7
    assert 'engine_damping' not in corners.varied
    assert len(set(corners.parameters)) == 2**7
    ratios = {
        round(p.values()[name] / IDENTIFIED_DRIVELINE.values()[name], 12)
        for p in corners.parameters
        for name in corners.varied
    }
    assert ratios == {1.0 - PARAMETER_SPREAD, 1.0 + PARAMETER_SPREAD}


def test_every_corner_has_the_actuator_that_is_given():
    late = ActuatorParameters(delay_s=0.014)
    corners = PlantCorners(actuator=late)
    controller = sampled('ls8')
    found = worst_corner(controller, corners)
    loop = sampled_loop(controller, corners.parameters[found.index], found.wear_gain, late)
    assert found.sensitivity_peak == pytest.approx(loop_margins(loop).sensitivity_peak, rel=1e-6)


def test_the_corners_of_one_plant_are_computed_once_and_those_of_another_anew():
    late = ActuatorParameters(delay_s=0.014)
    assert plant_corners() is plant_corners()
    assert plant_corners(actuator=late) is not plant_corners()
    assert plant_corners(actuator=late).actuator == late


@pytest.mark.parametrize('name', ['ls1', 'ls8', 'hinf1', 'hinf3'])
def test_its_sensitivity_peak_is_that_of_its_loop(name, corners):
    controller, found = sampled(name), worst_of(name)
    loop = sampled_loop(controller, corners.parameters[found.index], found.wear_gain)
    assert found.sensitivity_peak == pytest.approx(loop_margins(loop).sensitivity_peak, rel=1e-6)


@pytest.mark.parametrize('name', ['ls8'])
def test_no_corner_and_wear_gain_is_worse(name, corners):
    """Every sixteenth corner and two wear gains are tried."""
    controller, worst = sampled(name), worst_of(name).sensitivity_peak
    for parameters, gain in itertools.product(corners.parameters[::16], (0.7, 1.3)):
        margins = loop_margins(sampled_loop(controller, parameters, gain))
        assert margins.stable
        assert margins.sensitivity_peak <= worst * (1.0 + 1e-6)


@pytest.mark.parametrize('name', ['ls1'])
def test_nothing_inside_the_corners_is_worse(name, corners):
    """
    20 random drivelines and wear gains are tried.

    That is no proof: the worst driveline need not be at a corner.
    """
    controller, worst = sampled(name), worst_of(name).sensitivity_peak
    values, random = IDENTIFIED_DRIVELINE.values(), np.random.default_rng(1)
    for _ in range(20):
        factors = random.uniform(1.0 - PARAMETER_SPREAD, 1.0 + PARAMETER_SPREAD, 7)
        parameters = IDENTIFIED_DRIVELINE.with_values(
            **{
                name: factor * values[name]
                for name, factor in zip(corners.varied, factors, strict=True)
            }
        )
        loop = sampled_loop(controller, parameters, random.uniform(0.7, 1.3))
        assert loop_margins(loop).sensitivity_peak <= worst


@pytest.mark.parametrize('name', ['hinf2'])
def test_unstable_corners_are_those_with_an_unstable_pole_at_some_wear_gain(name, corners):
    controller, found = sampled(name), worst_of(name)
    unstable = sum(
        not all(
            closed_loop_stable(sampled_loop(controller, parameters, gain))
            for gain in np.linspace(0.7, 1.3, 7)
        )
        for parameters in corners.parameters
    )
    assert found.unstable_corners == unstable > 0
    assert found.sensitivity_peak is None
    worst = sampled_loop(controller, corners.parameters[found.index], found.wear_gain)
    assert not closed_loop_stable(worst)


@pytest.mark.parametrize(('gain', 'unstable'), [(1.0, 1), (1.5, 0)])
def test_a_loop_unstable_only_between_the_ends_of_the_wear_range_counts(gain, unstable):
    """
    L = (s^2 + s + 1.7)/(s^3 - 0.72): stable at the wear gains 0.7, 1 and 1.3.

    s^3 + k s^2 + k s + 1.7 k - 0.72 is stable where (k - 0.8)(k - 0.9) > 0, by Routh. The bilinear
    map keeps that; 1.5 times the gain moves the gap out of the range.
    """
    loop = control.c2d(
        control.ss(control.tf([1.0, 1.0, 1.7], [1.0, 0.0, 0.0, -0.72])), 0.1, 'tustin'
    )
    plant = StateSpace(loop.A, loop.B, loop.C, loop.D, PERIOD_S)
    response = frequency_response(plant, PlantCorners.omega)
    one_corner: Any = SimpleNamespace(
        plants=[plant],
        omega=PlantCorners.omega,
        responses=response[None, :],
        zeros=[locked_driveline_zero(IDENTIFIED_DRIVELINE)],
    )
    empty = np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0))
    controller = StateSpace(*empty, np.array([[gain]]), PERIOD_S)
    for wear_gain in WEAR_GAINS:
        assert closed_loop_stable(scaled(plant, gain * wear_gain))
    assert worst_corner(controller, one_corner).unstable_corners == unstable


def test_the_least_damping_of_the_mode_turns_negative_where_it_grows():
    assert worst_of('ls9').least_mode_damping < 0.0
    assert worst_of('ls1').least_mode_damping > 0.4
