# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The command on the page of a tuning over several scenarios runs the first of them."""

from pathlib import Path

import pytest
from printed_commands import run_printed
from small_tuning import made_tuning
from tuning_pages import ENGAGED, FILE, VARIED, commands_of, compared_settings

from ddct_bringup.tuning.tuned_names import PAGE

GAINS = 'proportional_gain: 0.18, integral_gain: 0.26'
"""Two of the launches engage with them; with the integral gain of the thesis only one does."""


def test_of_several_scenarios_the_command_has_the_first_and_the_page_names_the_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    grid = {'scenario': ['launch', 'launch_hot', 'launch_gentle'], 'duration_s': [2.0]}
    campaign = {'grid': grid, 'random': VARIED}
    Path('pi.yaml').write_text(FILE % GAINS, encoding='utf-8')
    options = {'trials': 1, 'campaign': campaign, 'constraints': ENGAGED}
    made_tuning(Path('tuning'), controller='pi.yaml', **options)
    compare, _ = commands_of(Path('tuning'))
    monkeypatch.chdir('tuning')
    assert run_printed(compare) == 0
    found = compared_settings(Path('..', 'tuned'))
    assert found.keys() == {'mine', 'mine_tuned'}
    assert {each.scenario.name for each in found.values()} == {'launch'}
    assert {each.known.clutch for each in found.values()} == {'stick_slip'}
    page = Path(PAGE).read_text(encoding='utf-8')
    assert 'The cases also have launch_hot, launch_gentle' in page
