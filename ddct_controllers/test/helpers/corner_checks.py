# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The worst corner of a printed controller, beside other drivelines and wear gains."""

import itertools
from collections.abc import Sequence
from functools import cache

import numpy as np

from ddct_controllers.design.analysis.loops import IDENTIFIED_DRIVELINE, sampled_loop
from ddct_controllers.design.analysis.margins import closed_loop_stable, loop_margins
from ddct_controllers.design.analysis.worst_corner import (
    PARAMETER_SPREAD,
    WorstCorner,
    plant_corners,
    worst_corner,
)
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.sampling import discretise_zoh


def sampled(name: str) -> StateSpace:
    """Return a printed controller, sampled with a hold."""
    return discretise_zoh(PRINTED_CONTROLLERS[name].to_state_space(), PERIOD_S)


@cache
def worst_of(name: str) -> WorstCorner:
    """Return the worst corner of a printed controller."""
    return worst_corner(sampled(name), plant_corners())


def peak_of(name: str) -> float:
    """Return the sensitivity peak at the worst corner of a controller stable at all corners."""
    peak = worst_of(name).sensitivity_peak
    assert peak is not None
    return peak


def require_no_worse_corner(name: str, *, every: int, gains: Sequence[float]) -> None:
    """Require that no corner of every few, and no wear gain of some, is worse."""
    controller, worst = sampled(name), peak_of(name)
    for parameters, gain in itertools.product(plant_corners().parameters[::every], gains):
        margins = loop_margins(sampled_loop(controller, parameters, gain))
        assert margins.stable
        assert margins.sensitivity_peak <= worst * (1.0 + 1e-6)


def require_nothing_worse_inside(name: str, *, count: int) -> None:
    """
    Require that none of so many random drivelines and wear gains is worse.

    That is no proof: the worst driveline need not be at a corner.
    """
    controller, worst = sampled(name), peak_of(name)
    values, random = IDENTIFIED_DRIVELINE.values(), np.random.default_rng(1)
    for _ in range(count):
        factors = random.uniform(1.0 - PARAMETER_SPREAD, 1.0 + PARAMETER_SPREAD, 7)
        parameters = IDENTIFIED_DRIVELINE.with_values(
            **{
                name: factor * values[name]
                for name, factor in zip(plant_corners().varied, factors, strict=True)
            }
        )
        loop = sampled_loop(controller, parameters, random.uniform(0.7, 1.3))
        assert loop_margins(loop).sensitivity_peak <= worst


def require_counted_unstable_corners(name: str) -> None:
    """Require that the unstable corners are those with an unstable pole at some wear gain."""
    controller, found, corners = sampled(name), worst_of(name), plant_corners()
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
