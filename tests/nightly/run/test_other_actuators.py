# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Gear shifts of cars with other actuators, which all know, with every controller."""

import pytest
from other_actuators import ACTUATORS, keys_of

from ddct_bringup.campaign.rows import scored_headless
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import ENGAGED
from ddct_controllers.registry import own_controller_names
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

FAILS = {
    'printed': {'mpc4', 'mpc4_wear'},
    'slow': {'mpc4', 'mpc4_wear'},
    'fast': set(),
}
"""Controllers that do not engage, by actuator; the thesis's others do with the printed one."""


@pytest.mark.parametrize('actuator', FAILS)
def test_every_controller_but_mpc4_engages_in_an_upshift_with_the_actuator_of_its_car(
    actuator: str,
) -> None:
    scenario = load_scenario('upshift', keys_of(ACTUATORS[actuator]))
    settings, limits = RunSettings(KnownSettings(scenario)), packaged_limits()
    states = {
        name: scored_headless(settings, name, limits).state for name in own_controller_names()
    }
    assert len(states) == 30
    assert {name for name, state in states.items() if state != ENGAGED} == FAILS[actuator]
