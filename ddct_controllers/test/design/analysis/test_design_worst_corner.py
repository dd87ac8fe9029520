# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""No corner, wear gain of the range, or point inside the corners is worse than the worst one."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from corner_checks import (
    require_counted_unstable_corners,
    require_no_worse_corner,
    require_nothing_worse_inside,
    sampled,
    worst_of,
)

from ddct_controllers.design.analysis.driveline_mode import locked_driveline_zero
from ddct_controllers.design.analysis.loops import IDENTIFIED_DRIVELINE, sampled_loop
from ddct_controllers.design.analysis.margins import closed_loop_stable, loop_margins
from ddct_controllers.design.analysis.worst_corner import (
    PARAMETER_SPREAD,
    WEAR_GAINS,
    PlantCorners,
    plant_corners,
    worst_corner,
)
from ddct_controllers.design.loop_stack import LoopStack
from ddct_controllers.design.state_space import frequency_response, scaled
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace
from ddct_plant.models.actuator import ActuatorParameters

pytestmark = pytest.mark.slow


@pytest.fixture(scope='module')
def corners() -> PlantCorners:
    return plant_corners()


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


def test_no_corner_and_wear_gain_is_worse():
    require_no_worse_corner('ls8', every=16, gains=(0.7, 1.3))


def test_nothing_inside_the_corners_is_worse():
    require_nothing_worse_inside('ls1', count=20)


def test_unstable_corners_are_those_with_an_unstable_pole_at_some_wear_gain():
    require_counted_unstable_corners('hinf2')


@pytest.mark.parametrize(('gain', 'unstable'), [(1.0, 1), (1.5, 0)])
def test_a_loop_unstable_only_between_the_ends_of_the_wear_range_counts(gain, unstable):
    """
    L = (s^2 + s + 1.7)/(s^3 - 0.72): stable at the wear gains 0.7, 1 and 1.3.

    s^3 + k s^2 + k s + 1.7 k - 0.72 is stable where (k - 0.8)(k - 0.9) > 0, by Routh. The bilinear
    map keeps that; 1.5 times the gain moves the gap out of the range.
    """
    import control

    loop = control.c2d(
        control.ss(control.tf([1.0, 1.0, 1.7], [1.0, 0.0, 0.0, -0.72])), 0.1, 'tustin'
    )
    plant = StateSpace(loop.A, loop.B, loop.C, loop.D, PERIOD_S)
    response = frequency_response(plant, PlantCorners.omega)
    one_corner: Any = SimpleNamespace(
        plants=LoopStack.joined([plant]),
        omega=PlantCorners.omega,
        responses=response[None, :],
        zeros=np.array([locked_driveline_zero(IDENTIFIED_DRIVELINE)]),
    )
    empty = np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((1, 0))
    controller = StateSpace(*empty, np.array([[gain]]), PERIOD_S)
    for wear_gain in WEAR_GAINS:
        assert closed_loop_stable(scaled(plant, gain * wear_gain))
    assert worst_corner(controller, one_corner).unstable_corners == unstable


def test_the_least_damping_of_the_mode_turns_negative_where_it_grows():
    assert worst_of('ls9').least_mode_damping < 0.0
    assert worst_of('ls1').least_mode_damping > 0.4
