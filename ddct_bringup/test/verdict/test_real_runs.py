"""States of runs of the closed loop, good and spoiled."""

import dataclasses

import pytest

from ddct_bringup.run.headless import run_headless
from ddct_bringup.verdict.limits_file import packaged_limits
from ddct_bringup.verdict.state import slip_state
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

THESIS = load_scenario('thesis')
START = THESIS.control_start_step


def state(controller='pi', gain=1.0, duration_s=3.0, **settings):
    """Return the state of a run whose PI has its gains multiplied."""
    gains = {key: gain * value for key, value in THESIS.controllers['pi'].items()}
    scenario = dataclasses.replace(THESIS, controllers={'pi': gains}, duration_s=duration_s)
    trajectory = run_headless(RunSettings(scenario, **settings), controller)
    return slip_state(trajectory, START, packaged_limits().rules)


def test_the_pi_of_the_thesis_engages():
    assert state() == 'engaged'


@pytest.mark.parametrize('wear_gain', [0.7, 1.0, 1.3])
def test_a_pi_of_the_wrong_sign_runs_away(wear_gain):
    assert state(gain=-1.0, wear_gain=wear_gain, duration_s=5.0) == 'runaway'
