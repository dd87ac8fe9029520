# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""States of closed-loop runs, with intact and with degraded controllers."""

import dataclasses

import pytest
from labelled_runs import Spoiled

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.engagement import Engagement
from ddct_bringup.run.headless import run_headless
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import state_of
from ddct_controllers.interface import Command, Controller
from ddct_controllers.linear import PI_OPTIONS
from ddct_controllers.registry import make_controller
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

THESIS = load_scenario('thesis')


class WrongSign(Controller):
    """The PI of the thesis with the wrong sign of its output."""

    def __init__(self):
        self._right = make_controller('pi', KnownSettings(THESIS))

    def reset(self):
        self._right.reset()

    def update(self, measurement):
        return Command(-self._right.update(measurement).clutch_torque)


def run(controller='pi', gain=1.0, duration_s=3.0, clutch='linear', **settings):
    """Return a run of the thesis's scenario with the gains of the PI multiplied by `gain`."""
    gains = {key: gain * option.default for key, option in PI_OPTIONS.items()}
    scenario = dataclasses.replace(
        THESIS, controllers={'pi': gains}, duration_s=duration_s, clutch=clutch
    )
    return run_headless(RunSettings.of(scenario, settings), controller)


def state(trajectory, start=THESIS.control_start_step):
    engagement = Engagement(trajectory, start, (start, trajectory.steps))
    return state_of(engagement, None, packaged_limits().rules).name


def state_degraded(controller, settings, end_s=None, gain=1.0, delay_steps=0):
    """Return the state of a run up to `end_s`; `gain` and `delay_steps` degrade the controller."""
    made = make_controller(controller, settings.known)
    whole = run_headless(settings, Spoiled(made, gain, delay_steps) if gain != 1.0 else made)
    rows = None if end_s is None else round(100 * end_s) + 1
    trajectory = Trajectory({name: values[:rows] for name, values in whole.signals.items()})
    return state(trajectory, settings.scenario.control_start_step)


def test_the_pi_of_the_thesis_engages():
    assert state(run()) == 'engaged'


def test_a_tenth_of_its_gains_has_not_engaged_when_the_run_ends_but_later():
    assert state(run(gain=0.1)) == 'not_engaged'
    assert state(run(gain=0.1, duration_s=6.0)) == 'engaged'


@pytest.mark.parametrize('duration_s', [2.0, 2.5, 3.0, 6.0])
@pytest.mark.parametrize('gain', [4.0, 8.0])
def test_too_high_a_gain_is_not_engaged_whenever_the_run_ends(gain, duration_s):
    cycling = run(gain=gain, duration_s=duration_s)
    assert abs(rpm_from_rad_s(cycling.slip_speed[-100:])).max() > 270.0
    assert state(cycling) == 'not_engaged'


def test_a_pi_of_the_wrong_sign_is_not_engaged_though_it_may_cross_zero():
    trajectory = run(WrongSign(), duration_s=5.0)
    assert abs(rpm_from_rad_s(trajectory.slip_speed[-1])) > 8000.0
    assert state(trajectory) == 'not_engaged'


def test_plates_that_stick_at_wear_1_3_never_part_and_are_engaged():
    assert state(run('ls8', wear_gain=1.3, clutch='stick_slip')) == 'engaged'
    assert state(run('ls8', wear_gain=1.3)) == 'not_engaged'


def test_a_worn_clutch_that_sticks_does_not_engage_under_the_pi_in_time():
    assert state(run(wear_gain=0.7, clutch='stick_slip')) == 'not_engaged'


@pytest.mark.parametrize('controller', ['ls8', 'pi', 'hinf1'])
def test_a_drive_whose_torque_steps_part_the_plates_for_a_while_ends_engaged(controller):
    changes = (
        'duration_s=6',
        'engine.time_s=[0,0.5,1.8,2.1,3,3.2,4.2,4.4,6]',
        'engine.torque_n_m=[5,260,260,100,100,220,220,60,60]',
    )
    settings = RunSettings(KnownSettings(load_scenario('thesis_sticking', changes)))
    assert state_degraded(controller, settings) == 'engaged'


@pytest.mark.parametrize('end_s', [3.0, 3.2, 3.55, 3.63, 3.64, 3.65])
def test_a_limit_cycle_of_1400_rpm_is_no_engagement_though_the_plates_lock_in_between(end_s):
    scenario = load_scenario('launch_hot', ['closing=null', 'duration_s=4'])
    settings = RunSettings(KnownSettings(scenario), CaseSettings(wear_gain=0.6))
    ended = state_degraded('ls6', settings, end_s, gain=6.1, delay_steps=1)
    assert ended in ('not_engaged', 'late')
