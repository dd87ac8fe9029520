# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Each architecture adds its open loop, and starts feedback, as in the thesis."""

import inspect
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from refusals import refused

from ddct_controllers.architecture import make_architecture
from ddct_controllers.design.feedforward import Feedforward
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_controllers.linear import PiController
from ddct_plant.base.errors import DdctError, ForeignError, ParameterError
from ddct_plant.models.load import RoadLoad
from ddct_plant.models.static_torque import constant_slip_torque
from ddct_plant.scenario.choices.settings import ARCHITECTURES
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings
from ddct_plant.signals.topics import TORQUE_PARTS

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))
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
FEEDFORWARD = ['feedforward', 'feedforward_tanh']


class Recording(Controller):
    def __init__(self, torque=7.0):
        self.torque = torque
        self.calls = []

    def reset(self):
        self.calls.append('reset')

    def update(self, measurement):
        self.calls.append('update')
        return Command(self.torque, (('mine', 'yes'),))


def load_torque() -> float:
    scenario = SETTINGS.scenario
    return RoadLoad(scenario.load, scenario.vehicle).torque(6.0)


def static_torque() -> float:
    return constant_slip_torque(SETTINGS.scenario.driveline, 250.0, load_torque())


def test_detailed_holds_feedback_in_reset_until_control_starts():
    controller = Recording()
    request = make_architecture(SETTINGS.known, controller).update(BEFORE)
    assert request.torque == static_torque()
    assert controller.calls == ['reset']
    assert dict(request.status)['feedback'] == 'held off'


@pytest.mark.parametrize('name', [name for name in ARCHITECTURES if name != 'detailed'])
def test_the_others_have_feedback_from_the_first_step(name):
    controller = Recording()
    architecture = make_architecture(replace(SETTINGS.known, architecture=name), controller)
    request = architecture.update(replace(BEFORE, step=0))
    assert controller.calls == ['update']
    assert dict(request.status)['feedback'] == 'on'
    assert request.closed_loop == 7.0


def test_both_parts_add_up_and_are_numbers():
    request = make_architecture(SETTINGS.known, Recording()).update(ON)
    status = dict(request.status)
    assert request.torque == static_torque() + 7.0
    assert (request.open_loop, request.closed_loop, request.closing) == (static_torque(), 7.0, 0.0)
    assert list(request.parts.values()) == [static_torque(), 7.0, 0.0]
    assert list(request.parts) == [signal.name for signal in TORQUE_PARTS.signals]
    assert (status['saturated'], status['mine']) == ('false', 'yes')


def test_detailed_takes_the_equilibrium_of_the_scenario():
    scenario = replace(SETTINGS.scenario, equilibrium='full')
    request = make_architecture(replace(SETTINGS.known, scenario=scenario), Recording()).update(
        BEFORE
    )
    driveline = scenario.driveline
    damping = driveline.gear.total_ratio * driveline.shaft_damping * BEFORE.shaft_speed
    assert request.torque == constant_slip_torque(driveline, 250.0, load_torque() + damping)
    assert request.torque > static_torque()


def test_base_is_feedback_alone():
    request = make_architecture(replace(SETTINGS.known, architecture='base'), Recording()).update(
        ON
    )
    assert request.torque == 7.0
    assert request.open_loop == 0.0


@pytest.mark.parametrize('name', FEEDFORWARD)
def test_feedforward_adds_the_filters_torque_for_both_inputs(name):
    architecture = make_architecture(replace(SETTINGS.known, architecture=name), Recording())
    filter_ = Feedforward(SETTINGS.scenario.driveline, SETTINGS.scenario.actuator)
    for step in range(3):
        request = architecture.update(replace(BEFORE, step=step))
        expected = filter_.update(250.0, load_torque())
        assert request.torque == expected + 7.0
        assert request.open_loop == expected


def test_feedforward_leads_a_rising_torque_and_tends_to_the_static_one():
    filter_ = Feedforward(SETTINGS.scenario.driveline, SETTINGS.scenario.actuator)
    rising = [filter_.update(2.5 * step, load_torque()) for step in range(101)]
    assert rising[-1] > static_torque() + 5.0
    held = [filter_.update(250.0, load_torque()) for _ in range(300)]
    assert held[-1] == pytest.approx(static_torque(), rel=1e-4)


def test_while_feedback_is_off_the_engine_follows_the_driver():
    controller = Recording()
    assert make_architecture(SETTINGS.known, controller).update(BEFORE).engine_torque is None
    controller.commands_engine = True
    assert make_architecture(SETTINGS.known, controller).update(BEFORE).engine_torque == 250.0


def test_a_request_of_nothing_is_not_saturated():
    base = replace(SETTINGS.known, architecture='base')
    for torque, saturated in ((0.0, 'false'), (-1e-9, 'true')):
        request = make_architecture(base, Recording(torque)).update(ON)
        assert dict(request.status)['saturated'] == saturated


def test_a_negative_request_is_reported_as_saturated_but_passed_on():
    request = make_architecture(SETTINGS.known, Recording(-1e4)).update(ON)
    assert request.torque < 0.0
    assert dict(request.status)['saturated'] == 'true'


@pytest.mark.parametrize('torque', [math.nan, math.inf])
def test_a_command_that_is_not_finite_ends_the_run(torque):
    with refused(DdctError, "controller 'Recording': its torque at step 60"):
        make_architecture(SETTINGS.known, Recording(torque)).update(ON)


@pytest.mark.parametrize(
    'status',
    [
        *(None, 'solved', {'qp': 'solved'}, [('qp', 'solved')], ('qp', 'solved')),
        *((('qp', 1),), (('qp',),), (('qp', 'a', 'b'),), (['qp', 'solved'],), ((b'qp', 'a'),)),
        *((('qp', '\x1b[31m'),), (('qp', '\ud800'),), (('qp', 'a\0b'),), (('qp', 'a\nb'),)),
    ],
)
def test_a_status_that_the_graph_cannot_carry_names_controller_and_step(status):
    controller: Any = Recording()
    controller.registered_name = 'mine'
    controller.update = lambda measurement: Command(7.0, status)
    with pytest.raises(DdctError) as caught:
        make_architecture(SETTINGS.known, controller).update(ON)
    assert str(caught.value).startswith(f"controller 'mine': its status at step {START} is ")
    assert str(caught.value).isprintable()


@pytest.mark.parametrize(('measurement', 'method'), [(ON, 'update'), (BEFORE, 'hold')])
def test_a_controller_that_raises_is_named_with_the_step_and_the_line(measurement, method):
    controller = Recording()
    controller.registered_name = 'mine'
    setattr(controller, method, lambda measurement: 1 / 0)
    line = inspect.currentframe().f_lineno - 1
    with pytest.raises(ForeignError) as caught:
        make_architecture(SETTINGS.known, controller).update(measurement)
    assert str(caught.value) == (
        f"controller 'mine': it failed at step {measurement.step} (ZeroDivisionError: division by "
        f'zero, in {Path(__file__).name} line {line}): mend the controller'
    )
    assert isinstance(caught.value.__cause__, ZeroDivisionError)


def test_numbers_that_diverge_end_the_run_with_the_controllers_name_and_the_step():
    def update(measurement):
        np.linalg.solve(np.zeros((2, 2)), np.ones(2))

    controller: Any = Recording()
    controller.registered_name = 'mine'
    controller.update = update
    with pytest.raises(DdctError) as caught:
        make_architecture(SETTINGS.known, controller).update(ON)
    assert str(caught.value) == (
        f"controller 'mine': it cannot go on at step {ON.step} (Singular matrix): the "
        'loop diverges in this scenario, or its options do not suit it'
    )


def test_changed_gains_act_all_or_none_from_the_next_update_on_and_stand_in_the_status():
    pi = PiController(0.1, 0.02)
    architecture = make_architecture(SETTINGS.known, pi)
    usual = architecture.update(ON)
    for wrong in ({'nix': 1.0}, {'integral_gain': 0.5, 'proportional_gain': -1.0}):
        with pytest.raises(ParameterError, match='nix: known: proportional_gain|at least 0'):
            architecture.change_gains(wrong)
    assert pi.gains() == {'proportional_gain': 0.1, 'integral_gain': 0.02}
    pi.reset()
    assert architecture.update(ON) == usual
    architecture.change_gains({'proportional_gain': 0.2})
    pi.reset()
    changed = architecture.update(ON)
    assert changed.closed_loop == 2.0 * usual.closed_loop
    place = f'{1_000_000_000 + START * 10_000_000} ns'
    pair = ('changed gains.proportional_gain', f'0.1 to 0.2 at {place}')
    assert changed.status == (*usual.status, pair)


@pytest.mark.parametrize('value', [True, '1', math.nan, None])
def test_a_gain_that_is_no_finite_number_is_refused(value):
    architecture = make_architecture(SETTINGS.known, PiController(0.1, 0.02))
    with refused(ParameterError, 'integral_gain'):
        architecture.change_gains({'integral_gain': value})


def test_a_gain_of_which_the_controller_does_not_report_the_value_is_refused():
    class Silent(Recording):
        def set_gain(self, name, value):
            self.torque = value

    controller = Silent()
    with pytest.raises(ParameterError, match='unknown gain torque'):
        make_architecture(SETTINGS.known, controller).change_gains({'torque': 1.0})
    assert controller.torque == 7.0
