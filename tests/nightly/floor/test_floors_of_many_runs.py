# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""No metric of a run is below its floor: scenarios with limits of the engine, and shifts."""

import pytest
from shift_cases import require_all_controllers_start_alike
from shift_cases import settings_of as shift_of

from ddct_bringup.floor.floor import floors_of_run
from ddct_bringup.floor.metric_units import METRICS, OF_STICK_SLIP
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.floors import with_least
from ddct_bringup.scores.scored_recording import simulate_and_score
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.handover.laws import HANDOVERS
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    """Compute the floors of each test, and take none from the user's cache."""
    monkeypatch.setenv('DDCT_CACHE', str(tmp_path / 'cache'))


@pytest.mark.parametrize(
    ('scenario', 'controller'),
    [
        ('launch', 'ls8'),
        ('launch_hot', 'mpc3'),
        ('thesis_sticking', 'hinf1'),
        ('thesis', 'mpc3'),
    ],
)
def test_no_metric_of_a_run_is_below_its_floor(scenario, controller):
    settings = RunSettings(KnownSettings(load_scenario(scenario)))
    run = run_headless(settings, controller)
    metrics = [name for name in METRICS if settings.stick_slip or name != OF_STICK_SLIP]
    for metric, over in floors_of_run(settings, metrics, run).items():
        assert over.value >= over.floor.least, metric


@pytest.mark.parametrize(
    ('scenario', 'handover', 'controller'),
    [('upshift', 'model', 'ls8'), ('upshift_hot', 'slip', 'mpc_preview')],
)
def test_no_metric_of_a_shift_is_below_its_floor(scenario, handover, controller):
    settings = shift_of(scenario, handover=handover)
    run = run_headless(settings, controller)
    for metric, over in floors_of_run(settings, list(METRICS), run).items():
        assert over.value >= over.floor.least, metric


@pytest.mark.parametrize('scenario', ['launch', 'thesis_sticking', 'thesis'])
def test_no_peak_jerk_is_below_a_least_that_is_a_bound(scenario):
    settings = RunSettings(KnownSettings(load_scenario(scenario)))
    bounds = 0
    for controller in ('ls8', 'mpc3', 'hinf1'):
        scored = simulate_and_score(RunPlan(settings, controller, 'headless'), packaged_limits())
        run = with_least(scored, packaged_limits()).scores
        if run.least_is_bound:
            bounds += 1
            assert run.metrics['peak_jerk_over_least'] >= 1.0, controller
    assert bounds >= 1


@pytest.mark.parametrize('handover', HANDOVERS)
def test_all_controllers_of_the_clutch_reach_the_inertia_phase_in_one_state(handover):
    require_all_controllers_start_alike(handover)
