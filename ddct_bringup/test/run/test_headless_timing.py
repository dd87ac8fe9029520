# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`timing.json` of a run without a graph counts its periods and its updates."""

from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.timing_and_failure import RunTiming
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings


def timing_of(settings):
    timing = RunTiming()
    trajectory = run_headless(settings, 'pi', timing)
    return timing, trajectory.steps


def test_the_steps_are_the_periods_and_there_is_an_update_for_each_state():
    scenario = load_scenario('thesis', ['duration_s=0.8'])
    timing, steps = timing_of(RunSettings(KnownSettings(scenario)))
    assert timing.steps == steps == scenario.steps == 80
    assert len(timing.update_times_us) == 81


def test_of_a_run_that_ends_early_they_are_those_that_were_run():
    limits = (
        *('engine_limits.over_rev_rad_s=200', 'engine_limits.cut_rad_s=199'),
        *('engine_limits.resume_rad_s=190', 'engine_limits.idle_rad_s=100'),
        'engine_limits.full_load_n_m=[0, 110, 170, 225, 250, 217, 165, 308]',
    )
    scenario = load_scenario('thesis_sticking', limits)
    timing, steps = timing_of(RunSettings(KnownSettings(scenario), CaseSettings(wear_gain=0.7)))
    assert timing.steps == steps < scenario.steps
    assert len(timing.update_times_us) == steps + 1
