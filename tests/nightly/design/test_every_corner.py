# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""No corner, wear gain of the range, or point inside the corners is worse than the worst one."""

import itertools

import numpy as np
import pytest

from ddct_controllers.design.analysis.loops import IDENTIFIED_DRIVELINE, sampled_loop
from ddct_controllers.design.analysis.margins import closed_loop_stable, loop_margins
from ddct_controllers.design.analysis.worst_corner import (
    PARAMETER_SPREAD,
    PlantCorners,
    WorstCorner,
    plant_corners,
    worst_corner,
)
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.sampling import discretise_zoh


@pytest.fixture(scope='module')
def corners() -> PlantCorners:
    return plant_corners()


def sampled(name: str) -> StateSpace:
    return discretise_zoh(PRINTED_CONTROLLERS[name].to_state_space(), PERIOD_S)


def worst_of(name: str) -> WorstCorner:
    return worst_corner(sampled(name), plant_corners())


@pytest.mark.parametrize('name', ['ls1', 'ls8', 'hinf1'])
def test_no_corner_and_wear_gain_is_worse(name, corners):
    """Every eighth corner and four wear gains are tried."""
    controller, worst = sampled(name), worst_of(name).sensitivity_peak
    for parameters, gain in itertools.product(corners.parameters[::8], (0.7, 0.9, 1.1, 1.3)):
        margins = loop_margins(sampled_loop(controller, parameters, gain))
        assert margins.stable
        assert margins.sensitivity_peak <= worst * (1.0 + 1e-6)


@pytest.mark.parametrize('name', ['ls1', 'ls8', 'hinf1'])
def test_nothing_inside_the_corners_is_worse(name, corners):
    """
    100 random drivelines and wear gains are tried.

    That is no proof: the worst driveline need not be at a corner.
    """
    controller, worst = sampled(name), worst_of(name).sensitivity_peak
    values, random = IDENTIFIED_DRIVELINE.values(), np.random.default_rng(1)
    for _ in range(100):
        factors = random.uniform(1.0 - PARAMETER_SPREAD, 1.0 + PARAMETER_SPREAD, 7)
        parameters = IDENTIFIED_DRIVELINE.with_values(
            **{
                name: factor * values[name]
                for name, factor in zip(corners.varied, factors, strict=True)
            }
        )
        loop = sampled_loop(controller, parameters, random.uniform(0.7, 1.3))
        assert loop_margins(loop).sensitivity_peak <= worst


@pytest.mark.parametrize('name', ['ls2', 'ls9', 'hinf2'])
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
