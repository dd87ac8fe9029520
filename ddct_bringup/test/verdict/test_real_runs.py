"""States of runs of the closed loop, good and spoiled."""

import dataclasses

import pytest

from ddct_bringup.run.headless import run_headless
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import slip_state
from ddct_controllers.interface import Command, Controller
from ddct_controllers.registry import make_controller
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

THESIS = load_scenario('thesis')


class WrongSign(Controller):
    """The PI of the thesis, its output added where it should be subtracted."""

    def __init__(self):
        self._right = make_controller('pi', RunSettings(THESIS))

    def reset(self):
        self._right.reset()

    def update(self, measurement):
        return Command(-self._right.update(measurement).clutch_torque)


def run(controller='pi', gain=1.0, duration_s=3.0, **settings):
    """Return a run of the thesis's scenario whose PI has its gains multiplied."""
    gains = {key: gain * value for key, value in THESIS.controllers['pi'].items()}
    scenario = dataclasses.replace(THESIS, controllers={'pi': gains}, duration_s=duration_s)
    return run_headless(RunSettings(scenario, **settings), controller)


def state(trajectory):
    return slip_state(trajectory, THESIS.control_start_step, packaged_limits().rules)


def test_the_pi_of_the_thesis_engages():
    assert state(run()) == 'engaged'


def test_a_tenth_of_its_gains_has_not_engaged_when_the_run_ends_but_later():
    assert state(run(gain=0.1)) == 'not_engaged'
    assert state(run(gain=0.1, duration_s=6.0)) == 'engaged'


@pytest.mark.parametrize('duration_s', [2.0, 2.5, 3.0, 6.0])
@pytest.mark.parametrize('gain', [4.0, 8.0])
def test_too_high_a_gain_oscillates_whenever_the_run_ends(gain, duration_s):
    cycling = run(gain=gain, duration_s=duration_s)
    assert abs(rpm_from_rad_s(cycling.slip_speed[-100:])).max() > 270.0
    assert state(cycling) == 'oscillating'


def test_a_pi_of_the_wrong_sign_runs_away_though_it_may_cross_zero():
    trajectory = run(WrongSign(), duration_s=5.0)
    assert abs(rpm_from_rad_s(trajectory.slip_speed[-1])) > 8000.0
    assert state(trajectory) == 'runaway'


def test_plates_that_stick_at_wear_1_3_never_part_and_are_engaged():
    assert state(run('ls8', wear_gain=1.3, clutch='stick_slip')) == 'engaged'
    assert state(run('ls8', wear_gain=1.3)) == 'not_engaged'


def test_a_worn_clutch_that_sticks_does_not_engage_under_the_pi_in_time():
    assert state(run(wear_gain=0.7, clutch='stick_slip')) == 'not_engaged'
