# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`ddct check` finds no fault with any packaged controller."""

import pytest

from ddct_controllers.check.checks import FAIL, SKIPPED, check_controller
from ddct_controllers.registry import controller_names
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings


@pytest.mark.parametrize('name', controller_names())
def test_a_packaged_controller_fails_no_check(name: str) -> None:
    outcomes = check_controller(name, KnownSettings(load_scenario('thesis')))
    assert [each for each in outcomes if each.state == FAIL] == []
    skipped = {each.name for each in outcomes if each.state == SKIPPED}
    assert skipped <= {'installation', 'preview', 'linear model'}
