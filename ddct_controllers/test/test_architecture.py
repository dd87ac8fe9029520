"""The detailed architecture adds the static torque and holds feedback until control starts."""

import math
from dataclasses import replace

import pytest

from ddct_controllers.architecture import DetailedArchitecture
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_plant.errors import DdctError
from ddct_plant.load import RoadLoad
from ddct_plant.run_settings import RunSettings
from ddct_plant.scenario_file import load_scenario
from ddct_plant.static_torque import constant_slip_torque

SETTINGS = RunSettings(load_scenario('thesis'))
START = SETTINGS.scenario.control_start_step
BEFORE = Measurement(
    step=START - 1,
    engine_speed=200.0,
    shaft_speed=180.0,
    wheel_speed=19.0,
    vehicle_speed=6.0,
    engine_torque=250.0,
    slip_reference=[20.0],
    slip_reference_rate=[0.0],
)
ON = replace(BEFORE, step=START)


class Recording(Controller):
    def __init__(self, torque=7.0):
        self.torque = torque
        self.calls = []

    def reset(self):
        self.calls.append('reset')

    def update(self, measurement):
        self.calls.append('update')
        return Command(self.torque, (('mine', 'yes'),))


def static_torque() -> float:
    scenario = SETTINGS.scenario
    load = RoadLoad(scenario.load, scenario.vehicle).torque(6.0)
    return constant_slip_torque(scenario.driveline, 250.0, load)


def test_feedback_is_held_in_reset_until_control_starts():
    controller = Recording()
    request = DetailedArchitecture(SETTINGS, controller).update(BEFORE)
    assert request.torque == static_torque()
    assert controller.calls == ['reset']
    assert dict(request.status)['feedback'] == 'held in reset'


def test_then_both_parts_add_up_and_the_status_says_so():
    request = DetailedArchitecture(SETTINGS, Recording()).update(ON)
    status = dict(request.status)
    assert request.torque == static_torque() + 7.0
    assert float(status['open_loop_torque_n_m']) == static_torque()
    assert float(status['closed_loop_torque_n_m']) == 7.0
    assert (status['saturated'], status['mine']) == ('false', 'yes')


def test_a_negative_request_is_reported_as_saturated_but_passed_on():
    request = DetailedArchitecture(SETTINGS, Recording(-1e4)).update(ON)
    assert request.torque < 0.0
    assert dict(request.status)['saturated'] == 'true'


@pytest.mark.parametrize('torque', [math.nan, math.inf])
def test_a_command_that_is_not_finite_ends_the_run(torque):
    with pytest.raises(DdctError, match=f'torque at step {START} is'):
        DetailedArchitecture(SETTINGS, Recording(torque)).update(ON)
