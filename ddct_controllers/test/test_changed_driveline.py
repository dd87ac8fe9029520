# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers that are computed from the scenario's driveline change with it, printed ones not."""

import pytest

from ddct_controllers.interface import Controller
from ddct_controllers.linear import LinearController
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_controllers.registry import make_controller
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

CHANGED = RunSettings(
    KnownSettings(load_scenario('thesis', ['driveline.halfshaft_stiffness=8000']))
)
AS_IT_IS = RunSettings(KnownSettings(load_scenario('thesis')))
FIXED = ('pi', *PRINTED_CONTROLLERS)
COMPUTED = ('hinf_thesis', 'hinf_fitted', 'hinf_sampled', 'lqi')


def numbers(controller: Controller) -> list[bytes]:
    model = controller.linear_model()
    assert model is not None
    return [getattr(model, part).tobytes() for part in 'abcd']


@pytest.mark.parametrize('name', [*FIXED, *COMPUTED])
def test_a_controller_changes_with_the_driveline_unless_it_is_printed(name: str) -> None:
    before, after = (numbers(make_controller(name, run.known)) for run in (AS_IT_IS, CHANGED))
    assert (before == after) == (name in FIXED)


def test_a_printed_controller_is_discretised_once_and_each_has_a_state_of_its_own() -> None:
    first, second = (make_controller('ls8', run.known) for run in (AS_IT_IS, CHANGED))
    assert first.linear_model() is second.linear_model()
    assert isinstance(first, LinearController)
    assert isinstance(second, LinearController)
    assert first._filter is not second._filter
    doubled = RunSettings(KnownSettings(load_scenario('thesis', ['controllers.ls8.gain=-2'])))
    assert numbers(make_controller('ls8', doubled.known)) != numbers(first)
