# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A slip reference given over time counts from control start, in every architecture that can."""

import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings
from ddct_reference.factory import make_reference

POINTS = 'slip_reference={time_s: [0.0, 0.6, 0.8], slip_rad_s: [50.0, 50.0, 10.0]}'
SCENARIO = load_scenario('thesis', ['reference.shape=profile', POINTS])


@pytest.mark.parametrize('architecture', ['detailed', 'feedforward'])
def test_it_is_the_profile_with_the_rate_of_the_coming_period(architecture):
    reference = make_reference(KnownSettings(SCENARIO, architecture), preview_steps=2)
    for step in range(59):
        reference.update(step, 3.0)
    before = reference.update(59, 3.0)[0][0]
    assert before == 3.0 if architecture == 'detailed' else before != 50.0
    speeds, rates = reference.update(60, 3.0)
    assert speeds == pytest.approx([50.0, 48.0, 46.0])
    assert rates == pytest.approx([-200.0, -200.0, -200.0])
    speeds, rates = reference.update(80, 3.0)
    assert (speeds, rates) == ([10.0] * 3, [0.0] * 3)


def test_the_shape_and_the_points_come_together_or_are_refused():
    with refused(ParameterError, key='reference.shape'):
        RunSettings(KnownSettings(load_scenario('thesis', ['reference.shape=profile'])))
    with refused(ParameterError, key='reference.shape'):
        RunSettings(KnownSettings(load_scenario('thesis', [POINTS])))
