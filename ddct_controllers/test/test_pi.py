# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The PI acts on rpm, with the thesis's sign, and takes only gains it has."""

import pytest
from refusals import refused

from ddct_controllers.interface import Measurement
from ddct_controllers.linear import PiController
from ddct_controllers.registry import make_controller
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.units import rad_s_from_rpm
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings


def measurement(error_rpm: float) -> Measurement:
    return Measurement(
        step=60,
        engine_speed=200.0,
        shaft_speed=200.0,
        wheel_speed=20.0,
        vehicle_speed=6.0,
        engine_torque=100.0,
        slip_reference=[rad_s_from_rpm(error_rpm)],
        slip_reference_rate=[0.0],
    )


def test_it_is_minus_the_gains_on_the_error_and_its_integral_in_rpm():
    pi = PiController(0.5, 2.0)
    torques = [pi.update(measurement(error)).clutch_torque for error in (10.0, 20.0, 0.0)]
    assert torques == pytest.approx([-5.0, -(10.0 + 2.0 * 0.1), -2.0 * 0.3])


def test_reset_empties_the_integral():
    pi = PiController(0.5, 2.0)
    pi.update(measurement(10.0))
    pi.reset()
    assert pi.update(measurement(10.0)).clutch_torque == pytest.approx(-5.0)


def test_a_gain_changes_between_updates_without_losing_the_integral():
    pi = PiController(0.5, 2.0)
    pi.update(measurement(10.0))
    pi.set_gain('integral_gain', 4.0)
    assert pi.gains() == {'proportional_gain': 0.5, 'integral_gain': 4.0}
    assert pi.update(measurement(0.0)).clutch_torque == pytest.approx(-0.4)


@pytest.mark.parametrize(
    ('name', 'value', 'key'),
    [('ki', 1.0, 'ki'), ('integral_gain', float('nan'), 'controllers.pi.integral_gain')],
)
def test_a_bad_gain_is_refused(name, value, key):
    with refused(ParameterError, key):
        PiController(0.5, 2.0).set_gain(name, value)


@pytest.mark.parametrize(
    ('gains', 'key'),
    [
        ('{proportional_gain: none}', 'controllers.pi.proportional_gain'),
        ('{proportional_gain: 0.1, integral_gain: -1.0}', 'controllers.pi.integral_gain'),
        (
            '{proportional_gain: 0.1, integral_gain: 0.1, d: 1.0}',
            'controllers.pi.d',
        ),
    ],
)
def test_a_scenario_with_bad_gains_is_refused(gains, key):
    settings = RunSettings(KnownSettings(load_scenario('thesis', [f'controllers.pi={gains}'])))
    with refused(ParameterError, key=key):
        make_controller('pi', settings.known)
