# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Linear systems of scipy.signal and python-control are controllers."""

import sys
from typing import Any

import numpy as np
import pytest
from made_later import later
from refusals import refused

from ddct_controllers.design.state_space import frequency_response
from ddct_controllers.lti_objects import controller_from
from ddct_plant.base.errors import ParameterError

NUM, DEN = [-0.03, -0.5, -0.6], [1.0, 8.0, 0.0]
OMEGA = np.geomspace(0.01, 300.0, 50)


def continuous() -> Any:
    from scipy import signal

    return signal.TransferFunction(NUM, DEN)


def sampled() -> Any:
    return continuous().to_discrete(0.01, 'zoh')


@pytest.mark.parametrize(
    'made',
    [
        *(continuous, lambda: continuous().to_zpk(), lambda: continuous().to_ss()),
        *(sampled, lambda: sampled().to_zpk(), lambda: sampled().to_ss()),
        *(later('control.tf', NUM, DEN), later('control.tf2ss', NUM, DEN)),
        later('control.tf', NUM, DEN, None),
        lambda: later('control.c2d', later('control.tf', NUM, DEN)(), 0.01, 'zoh')(),
        lambda: later('control.c2d', later('control.tf2ss', NUM, DEN)(), 0.01, 'zoh')(),
    ],
)
def test_each_is_the_same_controller_as_scipy_samples_it(made):
    from scipy import signal

    found = controller_from(made()).linear_model()
    assert found.period_s == 0.01
    _, expected = signal.dfreqresp(sampled(), OMEGA * 0.01)
    np.testing.assert_allclose(frequency_response(found, OMEGA), expected, rtol=1e-6)


def test_a_continuous_one_may_be_sampled_by_the_bilinear_rule():
    from scipy import signal

    found = controller_from(continuous(), 'bilinear').linear_model()
    _, expected = signal.dfreqresp(continuous().to_discrete(0.01, 'bilinear'), OMEGA * 0.01)
    np.testing.assert_allclose(frequency_response(found, OMEGA), expected, rtol=1e-6)


@pytest.mark.parametrize(
    ('made', 'discretisation', 'key'),
    [
        (
            later('scipy.signal.TransferFunction', NUM, DEN, dt=0.02),
            None,
            'dt',
        ),
        (later('scipy.signal.TransferFunction', NUM, DEN, dt=True), None, 'dt'),
        (later('control.tf', NUM, DEN, True), None, 'dt'),
        (sampled, 'hold', 'discretisation'),
        (continuous, 'zoh', 'discretisation'),
        (later('control.tf', [[[1], [2]]], [[[1, 1], [1, 2]]]), None, 'output'),
        (later('control.tf', [[[1], [2]]], [[[1, 1], [1]]]), None, 'output'),
        (later('control.tf', [1, 2, 3], [1, 2]), None, 'zeros'),
        (later('control.ss', [[0]], [[1, 2]], [[1]], [[0, 0]]), None, 'state space'),
        (later('scipy.signal.ZerosPolesGain', [], [1j], 1.0), None, 'poles'),
        (later('control.tf', [np.nan], [1]), None, 'transfer function: gain'),
        (lambda: [1.0], None, 'builtins.list'),
    ],
)
def test_a_system_that_cannot_run_is_named(made, discretisation, key):
    with refused(ParameterError, key):
        controller_from(made(), discretisation)


def test_it_needs_no_python_control(monkeypatch):
    monkeypatch.setitem(sys.modules, 'control', None)  # an import of it fails
    assert controller_from(continuous()).linear_model().period_s == 0.01


def test_a_system_in_our_own_form_is_taken_as_it_is():
    ours = controller_from(continuous()).linear_model()
    assert controller_from(ours).linear_model() is ours
