# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every stored scenario is admissible, and the search keeps the window ends that have one."""

import pytest

from ddct_bringup.reproduction.calibration import ensemble
from ddct_bringup.reproduction.calibration.ensemble import (
    find_members,
    members,
    why_not_admissible,
)
from ddct_bringup.reproduction.calibration.parameters import values_of
from ddct_plant.scenario.file import load_scenario

FROZEN = load_scenario('thesis')
MEMBERS = {member.name: member for member in members()}


@pytest.mark.parametrize('name', MEMBERS)
def test_member_passes_the_rule_on_its_nine_values(name):
    assert why_not_admissible(MEMBERS[name]) == []


def test_search_keeps_each_window_end_that_has_an_admissible_scenario(monkeypatch):
    """The search is replaced by one that returns its start, so only admissible ones are kept."""
    told: list[str] = []
    monkeypatch.setattr(ensemble, 'centre', lambda problem, start: tuple(start))
    monkeypatch.setattr(ensemble, 'rim', lambda problem, start, along: tuple(start))
    monkeypatch.setattr(ensemble, 'WINDOW_ENDS_S', (1.5, 1.6, 1.7, 1.8, 3.0))
    found = find_members(FROZEN, told.append)
    names = [member.name for member in found]
    assert names[:2] == ['window_1.6', 'window_1.7']
    assert not {'window_1.5', 'window_3.0'} & set(names)
    assert all(values_of(member) == values_of(FROZEN) for member in found)
    assert any(text.startswith('rim: ') for text in told)
