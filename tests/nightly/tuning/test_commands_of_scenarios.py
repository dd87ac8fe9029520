# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The command on the page of a tuning over several scenarios runs the first of them."""

from pathlib import Path

import pytest
from printed_commands import run_printed
from small_tuning import made_tuning
from tuning_pages import ENGAGED, FILE, VARIED, commands_of, compared_settings

from ddct_bringup.tuning.tuned_names import PAGE


def test_of_several_scenarios_the_command_has_the_first_and_the_page_names_the_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    grid = {'scenario': ['launch', 'launch_hot', 'launch_gentle'], 'duration_s': [2.0]}
    campaign = {'grid': grid, 'random': VARIED}
    Path('pi.yaml').write_text(FILE % 'proportional_gain: 0.2', encoding='utf-8')
    options = {'trials': 1, 'campaign': campaign, 'constraints': ENGAGED}
    made_tuning(Path('tuned'), controller='pi.yaml', **options)
    compare, _ = commands_of(Path('tuned'))
    assert run_printed(compare) == 0
    found = compared_settings(Path('runs', 'tuned'))
    assert found.keys() == {'mine_tuned'}  # the other one has no integral gain of its own
    assert {each.scenario.name for each in found.values()} == {'launch'}
    assert {each.clutch for each in found.values()} == {'stick_slip'}
    page = Path('tuned', PAGE).read_text(encoding='utf-8')
    assert 'The cases also have launch_hot, launch_gentle' in page
