# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Runs whose state or limits were once too mild, or could not be as good as the run."""

from functools import cache

import pytest

from ddct_bringup.reproduction.study_run import study_run
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings


@cache
def scores(controller, scenario='thesis_sticking', wear_gain=1.0, changes=()):
    settings = RunSettings(
        KnownSettings(load_scenario(scenario, changes)), CaseSettings(wear_gain=wear_gain)
    )
    return study_run(settings, controller).scores


def limit_of(run, name):
    return next(each for each in run.limits if each.name == name)


def test_a_stalled_run_is_no_engaged_one():
    assert scores('pi', 'launch_hill', 1.3).state == 'stalled'


def test_heating_the_plates_without_a_lock_is_not_engaged():
    run = scores('decoupled_pid', wear_gain=0.4, changes=('duration_s=6',))
    assert run.state == 'not_engaged'
    assert run.metrics['friction_work_j'] > 53e3
    assert run.metrics['time_to_final_lock_s'] is None


def test_plates_that_release_again_and_again_are_counted_beside_their_limit():
    run = scores('pi', 'launch_gentle', 1.3)
    assert run.state == 'engaged'
    releases = limit_of(run, 'releases')
    assert releases.value == run.metrics['releases'] > 10
    assert (releases.limit, releases.convention) == (0.0, True)


def test_a_driving_force_above_the_traction_of_the_front_wheels_stands_beside_its_limit():
    traction = limit_of(scores('mpc4', 'launch_gentle', 1.3), 'driving_acceleration_m_s2')
    assert traction.value > 12.0
    assert traction.limit == pytest.approx(4.905)
    assert (traction.unit, traction.convention) == ('m/s^2', True)


@pytest.mark.parametrize('controller', ['mpc3', 'mpc4', 'pedal_mpc'])
def test_a_predictive_controller_that_leaves_a_little_slip_has_not_engaged(controller):
    run = scores(controller)
    assert run.state == 'not_engaged'
    assert abs(run.metrics['slip_final_rpm']) < 10.0
