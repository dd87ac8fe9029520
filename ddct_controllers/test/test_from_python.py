# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Controllers out of Python objects."""

import numpy as np
import pytest
from refusals import refused

from ddct_controllers.from_python import chosen_from
from ddct_controllers.interface import Command, Controller, ControllerContext, ControllerSpec
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_controllers.registry import controller_label, make_controller
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis')))


class Mine(Controller):
    def __init__(self, context=None):
        self.resets = 0

    def reset(self):
        self.resets += 1

    def update(self, measurement):
        return Command(0.0)


def make_mine(context: ControllerContext) -> Controller:
    return Mine(context)


def model_of(system, name=''):
    return make_controller(chosen_from(system, name), SETTINGS.known).linear_model()


def test_names_and_files_stay_what_they_are(tmp_path):
    assert chosen_from('ls8') == 'ls8'
    assert chosen_from(tmp_path / 'mine.yaml') == str(tmp_path / 'mine.yaml')
    with refused(ParameterError, key='name'):
        chosen_from('ls8', 'other')


@pytest.mark.parametrize(
    ('given', 'name'), [(Mine, 'Mine'), (make_mine, 'make_mine'), (Mine(), 'Mine')]
)
def test_a_class_a_factory_and_an_object_have_their_own_or_the_given_name(given, name):
    assert controller_label(chosen_from(given)) == name
    chosen = chosen_from(given, 'given')
    assert controller_label(chosen) == 'given'
    made = make_controller(chosen, SETTINGS.known)
    assert isinstance(made, Mine)
    assert made.registered_name == 'given'


def test_an_object_is_used_itself_and_reset_for_each_run():
    mine = Mine()
    chosen = chosen_from(mine)
    assert make_controller(chosen, SETTINGS.known) is mine
    assert make_controller(chosen, SETTINGS.known) is mine
    assert mine.resets == 2
    with refused(ParameterError, key='controllers.Mine'):
        make_controller(chosen, SETTINGS.known, {'gain': 1.0})


@pytest.mark.parametrize('library', ['scipy', 'control'])
def test_a_continuous_system_is_discretised_as_the_printed_ones(library):
    import control
    import scipy.signal

    zeros, poles, gain = [-2.0], [0.0, -10.0], -3.0
    if library == 'scipy':
        system = scipy.signal.ZerosPolesGain(zeros, poles, gain)
    else:
        system = control.zpk(zeros, poles, gain)
    expected = scipy.signal.cont2discrete(
        scipy.signal.ZerosPolesGain(zeros, poles, gain).to_ss(), 0.01
    )
    omega = np.logspace(0, 2, 7)
    ours = model_of(system)
    assert ours.period_s == 0.01
    assert response(ours.a, ours.b, ours.c, ours.d, omega) == pytest.approx(
        response(expected.A, expected.B, expected.C, expected.D, omega), rel=1e-9
    )


@pytest.mark.parametrize('library', ['scipy', 'control'])
def test_a_sampled_system_is_taken_as_it_is(library):
    import control
    import scipy.signal

    tools = scipy.signal.dlti if library == 'scipy' else control.tf
    dt = {'dt': 0.01}
    ours = model_of(tools([-0.5, 0.4], [1.0, -1.0], **dt))
    step = [response_step(ours, k) for k in range(3)]
    assert step == pytest.approx([-0.5, -0.6, -0.7])


def test_our_own_forms_are_taken():
    assert model_of(PRINTED_CONTROLLERS['ls8'], 'mine').a.tolist() == (
        make_controller('ls8', SETTINGS.known).linear_model().a.tolist()
    )


@pytest.mark.parametrize(
    ('given', 'name', 'key', 'place'),
    [
        (3, '', '3', ''),
        (Mine, 'pi', 'pi', ''),
        (Mine, 'a b', 'controller name', ''),
        (lambda context: Mine(), '', 'controller name', ''),
    ],
)
def test_an_object_that_is_no_controller_is_refused_by_name(given, name, key, place):
    with refused(ParameterError, key, place):
        chosen_from(given, name)


def test_a_system_that_is_no_controller_is_refused_by_name():
    import control

    with refused(ParameterError, 'dt', "controller 'linear'"):
        chosen_from(control.tf([1], [1, 2], True), '')
    with refused(ParameterError, 'zeros', "controller 'steep'"):
        chosen_from(control.tf([1, 2, 3], [1, 2]), 'steep')


@pytest.mark.parametrize(
    ('given', 'key'),
    [
        (lambda context: 1, '<lambda>'),
        (lambda: 1, '<lambda>'),
    ],
)
def test_a_factory_of_no_controller_fails_when_it_is_called(given, key):
    with refused(DdctError, key):
        make_controller(chosen_from(given, 'mine'), SETTINGS.known)


def test_a_system_of_another_period_or_two_inputs_fails_when_it_is_made():
    import control

    for system, key in (
        (control.tf([1], [1, 2], 0.02), 'dt'),
        (control.ss([[0]], [[1, 1]], [[1]], [[0, 0]]), 'state space'),
    ):
        with refused(DdctError, key):
            make_controller(chosen_from(system, 'mine'), SETTINGS.known)


def test_a_spec_is_taken_as_it_is():
    spec = ControllerSpec('mine', make_mine, {})
    assert chosen_from(spec) is spec


def response(a, b, c, d, omega):
    """Return the frequency response of a system sampled at 10 ms."""
    identity = np.eye(len(a))
    return [(c @ np.linalg.solve(np.exp(0.01j * w) * identity - a, b) + d)[0, 0] for w in omega]


def response_step(model, k):
    """Return the k-th value of the step response."""
    state, value = np.zeros((len(model.a), 1)), 0.0
    for _ in range(k + 1):
        value = float((model.c @ state + model.d)[0, 0])
        state = model.a @ state + model.b
    return value
