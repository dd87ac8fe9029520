# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Runs whose verdict was once too mild, or could not be as good as the run."""

from functools import cache

import pytest

from ddct_bringup.reproduction.study_run import study_run
from ddct_plant.models.clutch import STICK_SLIP
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

GENTLE = ('engine.torque_n_m=[5, 30]', 'duration_s=4', 'reference.slope_rad_s2=5')


@cache
def verdict(controller, scenario='thesis', wear_gain=1.0, clutch=STICK_SLIP, changes=()):
    settings = RunSettings(load_scenario(scenario, changes), clutch=clutch, wear_gain=wear_gain)
    return study_run(settings, controller).verdict


def criterion(found, name):
    return next(each for each in found.criteria if each.name == name)


def test_a_linear_clutch_can_read_within_though_it_has_no_temperature_and_no_releases():
    found = verdict('hinf_sampled', clutch='linear', changes=GENTLE)
    assert (found.state, found.limits) == ('engaged', 'within')
    for name in ('peak_temperature', 'releases_after_lock'):
        each = criterion(found, name)
        assert (each.value, each.limit, each.state) == (None, None, 'no_limit')


def test_a_stalled_run_has_failed_its_limits():
    found = verdict('pi', 'launch_hill', 1.3)
    assert (found.state, found.limits) == ('stalled', 'failed')


def test_heating_the_plates_without_a_lock_is_nearly_engaged_and_beyond():
    found = verdict('decoupled_pid', wear_gain=0.4, changes=('duration_s=6',))
    assert (found.state, found.limits) == ('nearly_engaged', 'beyond')
    assert criterion(found, 'friction_energy').value > 58e3
    # Without a lock the number of releases is undefined, so it could not be within limits either.
    assert criterion(found, 'releases_after_lock').value is None
    assert criterion(found, 'releases_after_lock').limit == 0.0


def test_plates_that_release_again_and_again_are_beyond():
    found = verdict('pi', 'launch_gentle', 1.3)
    assert (found.state, found.limits) == ('engaged', 'beyond')
    releases = criterion(found, 'releases_after_lock')
    assert releases.value > 10
    assert (releases.convention, releases.state) == (True, 'beyond')


def test_a_driving_force_above_the_traction_of_the_front_wheels_is_beyond():
    found = verdict('mpc4', 'launch_gentle', 1.3)
    assert (found.state, found.limits) == ('engaged', 'beyond')
    traction = found.traction
    assert traction.value > 12.0
    assert traction.limit == pytest.approx(4.905)
    assert (traction.unit, traction.convention, traction.state) == (
        'm/s^2',
        True,
        'beyond',
    )
