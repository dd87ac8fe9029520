# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""In the packaged scenarios no controller that games the engine or the end of a run engages."""

from pathlib import Path

import pytest
from support.gaming_runs import gaming_file
from support.independent_figures import Figure, independent_figures

from ddct_bringup.api import Run, run
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.scenario.choices.scenarios import scenario_names
from ddct_plant.scenario.file import load_scenario

RULES = packaged_limits().rules
COMMANDING = ('withhold_share', 'withhold_below', 'add_below', 'no_least')
"""Controllers that command the engine, but not beyond the thresholds by intent."""
BEYOND = {'withhold_long': 'withheld', 'withhold_at_end': 'withheld', 'add_long': 'added'}
"""State by controller that commands the engine beyond a threshold."""
LATE = ('lock_at_end', 'creep')
LOCKED_WHILE_HOT = 'launch_hot'
"""Scenario whose facing grips more when it is hot, so that a constant request locks the plates."""
STICKING = [each for each in scenario_names() if load_scenario(each).clutch == 'stick_slip']
"""Scenarios whose plates can lock."""


def judged(name: str, scenario: str, out: Path) -> tuple[Run, dict[str, Figure]]:
    """Return a run, and its figures by an independent script."""
    made = run(gaming_file(name), scenario=scenario, out=out)
    assert made.valid
    return made, independent_figures(made.path)


def is_beyond(figures: dict[str, Figure]) -> bool:
    """Return whether a run withholds or adds more than the packaged thresholds."""
    withheld_s, added_s, share = (
        figures[key] for key in ('withheld_s', 'added_s', 'delivered_at_end')
    )
    assert withheld_s is not None and added_s is not None and share is not None
    return (
        withheld_s > RULES.withheld_time
        or added_s > RULES.added_time
        or share < RULES.delivered_share
    )


@pytest.mark.parametrize('scenario', scenario_names())
@pytest.mark.parametrize('name', [*COMMANDING, *BEYOND])
def test_no_run_that_withholds_or_adds_beyond_the_thresholds_is_engaged(
    name: str, scenario: str, tmp_path: Path
) -> None:
    made, figures = judged(name, scenario, tmp_path)
    if is_beyond(figures):
        assert made.state != 'engaged'
    else:
        assert made.state not in ('withheld', 'added')
    if name in BEYOND and scenario.startswith('launch'):
        assert is_beyond(figures)
        assert made.state == BEYOND[name]


@pytest.mark.parametrize('scenario', STICKING)
@pytest.mark.parametrize('name', LATE)
def test_no_controller_that_locks_at_the_end_or_never_is_engaged(
    name: str, scenario: str, tmp_path: Path
) -> None:
    made, figures = judged(name, scenario, tmp_path)
    locked = figures['time_to_final_lock_s']
    if scenario == LOCKED_WHILE_HOT:
        settings = load_scenario(scenario)
        assert locked is not None
        assert locked < settings.duration_s - settings.control_start_s - RULES.locked_time
    else:
        assert made.state == ('not_engaged' if locked is None else 'late')
