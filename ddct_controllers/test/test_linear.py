# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Printed controllers are sampled as the thesis samples them."""

import numpy as np
import pytest
from refusals import refused

from ddct_controllers.interface import Measurement
from ddct_controllers.linear import LinearController
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.units import rad_s_from_rpm
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace

ONE = np.eye(1)


def response(controller: LinearController, errors_rpm: list[float]) -> list[float]:
    return [
        controller.update(
            Measurement(
                step=0,
                engine_speed=0.0,
                shaft_speed=0.0,
                wheel_speed=0.0,
                vehicle_speed=0.0,
                engine_torque=0.0,
                slip_reference=[rad_s_from_rpm(error)],
                slip_reference_rate=[0.0],
            )
        ).clutch_torque
        for error in errors_rpm
    ]


def test_it_equals_the_continuous_controller_at_the_samples_of_a_held_error():
    """-2 (s + 3)/(s (s + 5)) by its step response in closed form, within 1e-12."""
    controller = LinearController(FactoredTransferFunction(-2.0, (3.0,), (0.0, 5.0)))
    times = 0.01 * np.arange(100)
    expected = -2.0 * (3.0 / 5.0 * times + 2.0 / 25.0 * (1.0 - np.exp(-5.0 * times)))
    assert response(controller, [1.0] * 100) == pytest.approx(expected, abs=1e-12)


def test_ls7_sampled_is_the_printed_z_form():
    """G_c(z) of Section 2.2.2, by its four-digit coefficients, agrees within 1 %."""
    ls8 = PRINTED_CONTROLLERS['ls8']
    ls7 = FactoredTransferFunction(-0.012057, ls8.numerator, ls8.denominator)
    numerator = -0.012057 * np.convolve([1.0, -0.9917], [1.0, -1.144, 0.3769])
    denominator = np.convolve([1.0, -1.0], [1.0, -1.915, 0.9481])
    errors = [1.0] * 40
    outputs: list[float] = []
    for k in range(len(errors)):
        past = sum(
            numerator[i] * errors[k - i] for i in range(len(numerator)) if k - i >= 0
        ) - sum(denominator[i] * outputs[k - i] for i in range(1, len(denominator)) if k - i >= 0)
        outputs.append(past)
    found = response(LinearController(ls7), errors)
    assert found == pytest.approx(outputs, abs=0.01 * max(map(abs, outputs)))


@pytest.mark.parametrize('name', sorted(PRINTED_CONTROLLERS))
def test_reset_removes_every_effect_of_earlier_errors(name):
    controller = LinearController(PRINTED_CONTROLLERS[name])
    fresh = response(controller, [1.0, 2.0, 3.0])
    controller.reset()
    assert response(controller, [1.0, 2.0, 3.0]) == fresh


def test_a_sampled_controller_is_taken_as_it_is():
    """The first outputs of G_c(z) = 3 + 2/(z - 0.5) are computed by hand."""
    model = StateSpace(0.5 * ONE, ONE, 2.0 * ONE, 3.0 * ONE, 0.01)
    controller = LinearController(model)
    assert response(controller, [1.0, 0.0, 2.0]) == pytest.approx([3.0, 2.0, 7.0])
    assert controller.linear_model() is model


@pytest.mark.parametrize(
    'model',
    [
        StateSpace(0.5 * ONE, ONE, 2.0 * ONE, 3.0 * ONE),
        StateSpace(0.5 * ONE, ONE, 2.0 * ONE, 3.0 * ONE, 0.02),
        StateSpace(0.5 * ONE, np.ones((1, 2)), 2.0 * ONE, np.array([[3.0, 1.0]]), 0.01),
    ],
)
def test_another_period_or_size_is_refused(model):
    with refused(ParameterError, 'state space'):
        LinearController(model)
