# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Linear systems of scipy.signal and python-control are controllers."""

import sys

import control
import numpy as np
import pytest
from refusals import refused
from scipy import signal

from ddct_controllers.design.state_space import frequency_response
from ddct_controllers.lti_objects import controller_from
from ddct_plant.base.errors import ParameterError

NUM, DEN = [-0.03, -0.5, -0.6], [1.0, 8.0, 0.0]
OMEGA = np.geomspace(0.01, 300.0, 50)
CONTINUOUS = signal.TransferFunction(NUM, DEN)
SAMPLED = CONTINUOUS.to_discrete(0.01, 'zoh')


@pytest.mark.parametrize(
    'lti',
    [
        *(CONTINUOUS, CONTINUOUS.to_zpk(), CONTINUOUS.to_ss()),
        *(SAMPLED, SAMPLED.to_zpk(), SAMPLED.to_ss()),
        *(control.tf(NUM, DEN), control.tf2ss(NUM, DEN), control.tf(NUM, DEN, None)),
        control.c2d(control.tf(NUM, DEN), 0.01, 'zoh'),
        control.c2d(control.tf2ss(NUM, DEN), 0.01, 'zoh'),
    ],
    ids=lambda lti: f'{type(lti).__module__}.{type(lti).__name__}',
)
def test_each_is_the_same_controller_as_scipy_samples_it(lti):
    found = controller_from(lti).linear_model()
    assert found.period_s == 0.01
    _, expected = signal.dfreqresp(SAMPLED, OMEGA * 0.01)
    np.testing.assert_allclose(frequency_response(found, OMEGA), expected, rtol=1e-6)


def test_a_continuous_one_may_be_sampled_by_the_bilinear_rule():
    found = controller_from(CONTINUOUS, 'bilinear').linear_model()
    _, expected = signal.dfreqresp(CONTINUOUS.to_discrete(0.01, 'bilinear'), OMEGA * 0.01)
    np.testing.assert_allclose(frequency_response(found, OMEGA), expected, rtol=1e-6)


@pytest.mark.parametrize(
    ('lti', 'discretisation', 'key'),
    [
        (
            signal.TransferFunction(NUM, DEN, dt=0.02),
            None,
            'dt',
        ),
        (signal.TransferFunction(NUM, DEN, dt=True), None, 'dt'),
        (control.tf(NUM, DEN, True), None, 'dt'),
        (SAMPLED, 'hold', 'discretisation'),
        (CONTINUOUS, 'zoh', 'discretisation'),
        (control.tf([[[1], [2]]], [[[1, 1], [1, 2]]]), None, 'output'),
        (control.tf([[[1], [2]]], [[[1, 1], [1]]]), None, 'output'),
        (control.tf([1, 2, 3], [1, 2]), None, 'zeros'),
        (control.ss([[0]], [[1, 2]], [[1]], [[0, 0]]), None, 'state space'),
        (signal.ZerosPolesGain([], [1j], 1.0), None, 'poles'),
        (control.tf([np.nan], [1]), None, 'transfer function: gain'),
        ([1.0], None, 'builtins.list'),
    ],
)
def test_a_system_that_cannot_run_is_named(lti, discretisation, key):
    with refused(ParameterError, key):
        controller_from(lti, discretisation)


def test_it_needs_no_python_control(monkeypatch):
    monkeypatch.setitem(sys.modules, 'control', None)  # an import of it fails
    assert controller_from(CONTINUOUS).linear_model().period_s == 0.01


def test_a_system_in_our_own_form_is_taken_as_it_is():
    ours = controller_from(CONTINUOUS).linear_model()
    assert controller_from(ours).linear_model() is ours
