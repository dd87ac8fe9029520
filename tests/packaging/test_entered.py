# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The counter of classes and functions that a run enters."""

import pytest
from samples import sampled

from ddct_bringup import api
from ddct_controllers.architecture import make_architecture
from ddct_controllers.registry import make_controller
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings
from entered.counter import Entered, Noun

pytestmark = pytest.mark.slow

LINEAR = Noun('ddct_plant.models.linear_driveline', 'Driveline')
FRICTION = Noun('ddct_plant.friction.driveline', 'FrictionDriveline')


@pytest.mark.parametrize(
    ('scenario', 'driveline'),
    sampled([('upshift', FRICTION), ('launch', FRICTION), ('thesis', LINEAR)], every=2),
)
def test_the_way_leads_from_the_call_to_the_equations_and_not_into_the_scores(
    scenario: str, driveline: Noun
) -> None:
    entered = Entered()
    entered.call(lambda: api.run('pi', scenario=scenario, duration=2.0))
    scored = Noun('ddct_bringup.scores.scoring', 'score_run')
    assert entered.way >= {
        Noun('ddct_bringup.api.run_and_load', 'run'),
        Noun('ddct_controllers.architecture', 'Architecture'),
        driveline,
    }
    assert scored in entered.nouns - entered.way


def test_what_no_step_follows_is_not_on_the_way() -> None:
    entered = Entered()
    settings = RunSettings(KnownSettings(load_scenario('thesis')))
    entered.call(lambda: make_architecture(settings.known, make_controller('pi', settings.known)))
    assert Noun('ddct_controllers.architecture', 'Architecture') in entered.nouns
    assert entered.way == set()
