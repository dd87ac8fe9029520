# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Quantities of a trial's loop: those that the goals name, and no others are computed."""

from typing import Any

import pytest
from small_tuning import CONTENT, tuning

from ddct_bringup.tuning.loop_quantities import loop_quantities
from ddct_controllers.design.analysis.loop_curve import LoopCurve
from ddct_controllers.design.analysis.worst_corner import plant_corners, worst_corner
from ddct_controllers.workflows.evidence import linear_model
from ddct_plant.base.errors import ParameterError

UNSTABLE, PEAK = {'unstable_corners': {'at_most': 0}}, {'corner_sensitivity_peak': {'at_most': 9}}


def quantities(*constraints: dict[str, Any], controller: str = 'pi') -> dict[str, float | None]:
    """Return the quantities for a specification with these constraints."""
    more = {name: value for each in constraints for name, value in each.items()}
    made = tuning(controller, constraints={**CONTENT['constraints'], **more})
    return loop_quantities(made.campaign, made.cases, made.spec.goals)


def test_without_a_goal_of_the_loop_nothing_of_it_is_computed(monkeypatch):
    monkeypatch.setattr('ddct_bringup.tuning.loop_quantities.CornerLoops', None)
    assert quantities() == {}


def test_no_margin_is_computed_for_the_number_of_unstable_corners(monkeypatch):
    monkeypatch.setattr(LoopCurve, 'peak', None)
    monkeypatch.setattr('ddct_controllers.workflows.evidence.loop_margins', None)
    assert quantities(UNSTABLE) == {'unstable_corners': 0.0}


def test_they_are_those_of_the_worst_corner():
    made = tuning('pi')
    settings = made.campaign.run(0).settings
    found = linear_model('pi', settings)
    assert found is not None
    worst = worst_corner(found[1], plant_corners())
    assert quantities(UNSTABLE, PEAK) == {
        'unstable_corners': float(worst.unstable_corners),
        'corner_sensitivity_peak': worst.sensitivity_peak,
    }


def test_a_controller_without_a_frequency_response_is_refused():
    weights = {'output_weight': {'low': 0.1, 'high': 1.0}}
    constraints = {**CONTENT['constraints'], **UNSTABLE}
    made = tuning('mpc3', parameters=weights, constraints=constraints)
    with pytest.raises(ParameterError) as refused:
        loop_quantities(made.campaign, made.cases, made.spec.goals)
    assert refused.value.key == 'unstable_corners'
