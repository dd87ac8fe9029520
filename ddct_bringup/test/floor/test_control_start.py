# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""One simulation up to control start serves all runs that start alike, and the report."""

import pytest

from ddct_bringup.floor import control_start as module
from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.dynamics.start import start_of
from ddct_bringup.report.front_view import front_view
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.floors import with_floors
from ddct_bringup.scores.scored_recording import simulate_and_score
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings


@pytest.fixture
def simulated(monkeypatch):
    """Return the numbers of steps of the simulations up to control start, as they are made."""
    steps = []
    run_loop = module.run_loop

    def counted(loop, count):
        steps.append(count)
        return run_loop(loop, count)

    monkeypatch.setattr(module, 'run_loop', counted)
    monkeypatch.setattr(module, '_kept', [])
    return steps


def settings_of(**further):
    return RunSettings.of(load_scenario('thesis'), further)


@pytest.mark.nightly
@pytest.mark.slow
def test_one_simulation_up_to_control_start_serves_a_comparison_and_its_report(simulated):
    runs = []
    for controller in ('pi', 'ls8'):
        plan = RunPlan(settings_of(), controller, 'headless')
        runs.append(simulate_and_score(plan, packaged_limits()))
    assert front_view(with_floors(runs, packaged_limits())) is not None
    assert simulated == [settings_of().scenario.control_start_step]


def test_other_settings_have_a_start_of_their_own(simulated):
    starts = [control_start(settings_of(wear_gain=gain)) for gain in (1.0, 0.9, 1.0)]
    assert len(simulated) == 2
    assert starts[0] is starts[2]
    assert starts[0].slip != starts[1].slip


def test_a_scenario_without_slip_is_simulated_once_too(simulated):
    settings = RunSettings(KnownSettings(load_scenario('tip_in')))
    for _ in range(2):
        with pytest.raises(ParameterError, match='do not slip at control start'):
            control_start(settings)
    assert len(simulated) == 1


def test_the_state_is_that_of_a_whole_run(simulated):
    settings = settings_of()
    whole = start_of(settings, run_headless(settings, 'ls8'))
    start = control_start(settings)
    assert list(start.state) == list(whole.state)
    assert list(start.actuator) == list(whole.actuator)
    assert list(start.accelerations) == list(whole.accelerations)
