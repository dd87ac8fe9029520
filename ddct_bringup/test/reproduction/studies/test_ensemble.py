# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Every stored scenario is admissible, matches its name, and was found by the rule alone."""

import dataclasses

import numpy as np
import pytest

from ddct_bringup.reproduction.calibration import ensemble
from ddct_bringup.reproduction.calibration.analysis import changed_assumptions
from ddct_bringup.reproduction.calibration.ensemble import (
    QUANTITIES,
    find_members,
    fitted_rows,
    members,
    why_not_admissible,
    write_members,
)
from ddct_bringup.reproduction.calibration.parameters import BASE, RANGE, values_of
from ddct_bringup.reproduction.calibration.problem import Problem
from ddct_bringup.reproduction.calibration.search import RIM, centre, rim
from ddct_bringup.thesis.predictions import folder_of_members
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.scenario import Scenario

pytestmark = pytest.mark.slow

FROZEN = load_scenario('thesis')
MEMBERS = {member.name: member for member in members()}


def worst(scenario: Scenario) -> float:
    return max(abs(row.deviation / row.tolerance) for row in fitted_rows(scenario))


def quiet(text: str) -> None:
    """Show no progress."""


@pytest.mark.parametrize('name', sorted(MEMBERS)[::6])
def test_member_passes_the_rule_on_its_nine_values(name):
    """All of them do: tests/nightly/reproduction."""
    assert why_not_admissible(MEMBERS[name]) == []


def test_frozen_window_and_its_neighbours_are_among_the_members():
    assert {'window_1.6', 'window_1.7', 'window_1.8'} <= set(MEMBERS)


@pytest.mark.parametrize('name', [name for name in MEMBERS if 'window' in name])
def test_member_differs_from_the_frozen_scenario_in_fitted_values_only(name):
    member = MEMBERS[name]
    again = Problem(member.score_window_s[1]).scenario(values_of(member))
    assert dataclasses.replace(again, name=name, description=member.description) == member


def test_members_with_another_assumption_differ_in_that_too():
    others = [member for name, member in MEMBERS.items() if 'window' not in name]
    bases = list(changed_assumptions().values())
    assert len(others) == len(bases) == 4
    for base in bases:
        assert [one for one in others if (one.load, one.initial) == (base.load, base.initial)]


@pytest.mark.parametrize('end', [1.6, FROZEN.score_window_s[1], 3.0])
@pytest.mark.parametrize('quantity', QUANTITIES)
def test_rim_is_on_both_sides_of_the_centre(end, quantity):
    """The torque level is at its bound in some centres, which are then the lowest themselves."""
    direction = np.array(QUANTITIES[quantity][1]) / RANGE
    along = {
        which: float(direction @ values_of(MEMBERS[f'window_{end}{which}']))
        for which in ('', f'_{quantity}_low', f'_{quantity}_high')
        if f'window_{end}{which}' in MEMBERS
    }
    middle = along.pop('')
    assert along[f'_{quantity}_high'] > middle
    assert along.get(f'_{quantity}_low', middle) <= middle
    assert quantity == 'level' or len(along) == 2


def test_centre_cannot_be_bettered_by_a_search_from_it():
    member = MEMBERS['window_1.7']
    found = centre(Problem(1.7), values_of(member))
    largest = np.max(np.abs(Problem(1.7).residuals(found)))
    assert largest == pytest.approx(worst(member), abs=0.01)
    assert largest < worst(FROZEN)


def test_rim_is_where_a_residual_reaches_its_limit():
    found = rim(Problem(1.7), values_of(MEMBERS['window_1.7']), QUANTITIES['slope'][1])
    largest = np.max(np.abs(Problem(1.7).residuals(found)))
    assert largest == pytest.approx(RIM, abs=5e-3)


def test_files_are_written_as_they_are_kept(tmp_path):
    (tmp_path / 'gone.yaml').write_text('old')
    write_members(list(MEMBERS.values()), tmp_path)
    kept = folder_of_members()
    for file in kept.glob('*.yaml'):
        assert (tmp_path / file.name).read_text() == file.read_text()
    assert {file.name for file in tmp_path.iterdir()} == {f'{name}.yaml' for name in MEMBERS}


def test_search_keeps_each_window_end_that_has_an_admissible_scenario(monkeypatch):
    """The search is replaced by one that returns its start, so only admissible ones are kept."""
    told: list[str] = []
    monkeypatch.setattr(ensemble, 'centre', lambda problem, start: tuple(start))
    monkeypatch.setattr(ensemble, 'rim', lambda problem, start, along: tuple(start))
    monkeypatch.setattr(ensemble, 'WINDOW_ENDS_S', (1.5, 1.7))
    found = find_members(FROZEN, told.append)
    names = [member.name for member in found]
    assert names[0] == 'window_1.7'
    assert 'window_1.5' not in names
    assert all(values_of(member) == values_of(FROZEN) for member in found)
    assert any(text.startswith('rim: ') for text in told)


def test_member_that_the_rule_does_not_admit_is_refused(monkeypatch):
    outside = (0.0, 308.0, 0.524, 90.0, 0.103, 0.0223)
    monkeypatch.setattr(ensemble, 'WINDOW_ENDS_S', (1.7,))
    monkeypatch.setattr(ensemble, 'rim', lambda problem, start, along: outside)
    with pytest.raises(DdctError, match=r'window_1\.7_level_low is not admissible: ls8 '):
        find_members(FROZEN, quiet)


def test_assumptions_are_those_of_the_calibration():
    assert BASE not in changed_assumptions().values()
