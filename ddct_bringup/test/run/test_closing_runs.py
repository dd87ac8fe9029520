# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""With the closing stage the plates stay together once they are; without it they part again."""

from functools import lru_cache

import pytest

from ddct_bringup.metrics.engagement import Engagement
from ddct_bringup.metrics.values import window_steps
from ddct_bringup.run.headless import run_headless
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

ON, OFF = 'closing={}', 'closing=null'


@lru_cache
def run(scenario, controller, *changes, wear_gain=1.0):
    settings = RunSettings(
        KnownSettings(load_scenario(scenario, changes)), CaseSettings(wear_gain=wear_gain)
    )
    trajectory = run_headless(settings, controller)
    start, window_s = settings.scenario.control_start_step, settings.scenario.score_window_s
    return Engagement(trajectory, start, window_steps(window_s)), trajectory


@pytest.mark.parametrize(
    ('scenario', 'controller'),
    [
        ('thesis_sticking', 'mpc3'),
        ('thesis_sticking', 'mpc_preview'),
        ('thesis_sticking', 'torque_estimator'),
        ('launch', 'mpc3'),
        ('launch_hill', 'ls8'),
    ],
)
def test_a_run_that_parts_again_without_it_stays_locked_with_it(scenario, controller):
    assert run(scenario, controller, OFF)[0].lockup.releases > 0
    judged, trajectory = run(scenario, controller, ON)
    assert judged.lockup.releases == 0
    assert dict(trajectory.status[-1])['closing'] == 'closed'


def test_a_tip_in_parts_only_the_plates_of_a_clutch_that_cannot_carry_the_swing():
    assert run('tip_in', 'pi', OFF)[0].lockup.releases > 0
    assert run('tip_in', 'pi', ON, 'friction.most_n_m=500')[0].lockup.releases == 0
    judged, trajectory = run('tip_in', 'pi', ON)
    assert trajectory.torque_request.max() > trajectory.clutch_torque.max() == 350.0
    assert judged.lockup.releases == 1
    assert dict(trajectory.status[-1])['closing'] == 'closed'


def test_it_changes_nothing_before_the_lock():
    judged, closing = run('thesis_sticking', 'mpc3', ON)
    _, without = run('thesis_sticking', 'mpc3', OFF)
    before = slice(0, judged.lockup.together_from - 1)
    assert (closing.torque_request[before] == without.torque_request[before]).all()
    assert (closing.joint_speed[before] == without.joint_speed[before]).all()


def test_a_worn_clutch_that_feedback_has_locked_stays_locked():
    for controller in ('ls8', 'mpc_offset_free'):
        judged, trajectory = run('thesis_sticking', controller, ON, wear_gain=0.7)
        assert (judged.lockup.releases, dict(trajectory.status[-1])['closing']) == (0, 'closed')


def test_the_engine_goes_back_to_the_driver_without_a_step():
    _, trajectory = run('launch', 'torque_estimator', ON)
    closed = [dict(pairs)['feedback'] == 'held off' for pairs in trajectory.status]
    first = closed.index(True, 100)
    changes = abs(trajectory.engine_torque[first + 1 :] - trajectory.engine_torque[first:-1])
    assert abs(trajectory.engine_torque[first] - trajectory.torque_demand[first]) > 20.0
    assert changes.max() < 2.0
    assert trajectory.engine_torque[-1] == trajectory.torque_demand[-1]
