# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The loops that margins are computed from are those of the thesis, and of the run."""

import math

import numpy as np
import pytest
from refusals import refused

from ddct_controllers.design.analysis.loops import (
    IDENTIFIED_DRIVELINE,
    continuous_loop,
    plant_in_rpm,
    sampled_loop,
    sampled_plant,
)
from ddct_controllers.design.state_space import close_loop, frequency_response, poles_rad_s, series
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rpm_from_rad_s
from ddct_plant.linear.lti import FactoredTransferFunction, StateSpace
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.actuator import Actuator, ActuatorParameters
from ddct_plant.models.clutch import LinearClutch
from ddct_plant.models.initial_state import InitialSide, InitialState
from ddct_plant.models.linear_driveline import Driveline
from ddct_plant.models.parameters import VehicleParameters

OMEGA = np.geomspace(1e-3, 300.0, 200)
LS2 = PRINTED_CONTROLLERS['ls2']
BASE_TORQUE = 100.0
"""Constant torque in N m that avoids saturation; its own response is subtracted."""


PRINTED = ActuatorParameters()


def slip_rpm_as_run(
    extra_torque: np.ndarray, wear_gain: float, parameters: ActuatorParameters = PRINTED
) -> np.ndarray:
    """Return w_d in rpm at t_0..t_N through the actuator, clutch and driveline that runs use."""

    def slip(extra: np.ndarray) -> np.ndarray:
        start = InitialState(
            engine_speed=160.0,
            wheel_speed=IDENTIFIED_DRIVELINE.gear.wheel_speed(160.0),
            twist=0.0,
            engine_torque=0.0,
            load_torque=0.0,
            sides=(InitialSide(160.0, BASE_TORQUE, wear_gain * BASE_TORQUE),),
        )
        driveline = Driveline(IDENTIFIED_DRIVELINE, VehicleParameters(), start)
        actuator, clutch = Actuator(BASE_TORQUE, parameters), LinearClutch(wear_gain)
        speeds = []
        for torque in extra:
            speeds.append(rpm_from_rad_s(driveline.outputs().slip_speed))
            driveline.step(0.0, 0.0, clutch.transmit(actuator.update(BASE_TORQUE + torque)))
        return np.array(speeds)

    return slip(extra_torque) - slip(np.zeros(len(extra_torque)))


SWING = 10.0 * (1.0 - np.cos(2.0 * math.tau * PERIOD_S * np.arange(200)))
"""Torque in N m that swings at 2 Hz, (steps,)."""


def response(plant: StateSpace, torque: np.ndarray) -> np.ndarray:
    """Return the output of a sampled plant at rest."""
    state, output = np.zeros(len(plant.a)), []
    for each in torque:
        output.append(plant.c[0] @ state + plant.d[0, 0] * each)
        state = plant.a @ state + plant.b[:, 0] * each
    return np.array(output)


@pytest.mark.parametrize('wear_gain', [0.7, 1.0, 1.3])
def test_the_sampled_plant_is_the_plant_that_runs(wear_gain):
    """
    They agree within 1e-4 of the peak for a torque swinging at 2 Hz.

    The difference comes from the run's 1 ms lines.
    """
    expected = response(sampled_plant(wear_gain=wear_gain), SWING)
    found = slip_rpm_as_run(SWING, wear_gain)
    assert found == pytest.approx(expected, abs=1e-4 * np.abs(found).max())


@pytest.mark.parametrize('delay_s', [0.0, 0.003, 0.01, 0.013, 0.027, 0.05])
@pytest.mark.parametrize('bandwidth_factor', [0.5, 1.0, 1.3])
def test_the_sampled_plant_has_the_actuator_that_runs(delay_s, bandwidth_factor):
    """Delays need not be whole periods; 1 ms more would change the response by 100 tolerances."""
    actuator = ActuatorParameters(delay_s, bandwidth_factor)
    expected = response(sampled_plant(actuator=actuator), SWING)
    found = slip_rpm_as_run(SWING, 1.0, actuator)
    assert found == pytest.approx(expected, abs=1e-4 * np.abs(found).max())


def test_the_request_of_a_step_moves_nothing_for_a_whole_period():
    """Delay of one sample and a strictly proper plant give two zero samples, then slip falls."""
    plant = sampled_plant()
    assert plant.d[0, 0] == 0.0
    assert (plant.c @ plant.b)[0, 0] == 0.0
    assert (plant.c @ plant.a @ plant.b)[0, 0] != 0.0


def test_the_continuous_loop_is_the_product_of_its_parts():
    expected = LS2.frequency_response(OMEGA) * plant_in_rpm().frequency_response(OMEGA)
    expected *= np.exp(-0.01j * OMEGA)
    loop = continuous_loop(LS2, delay_s=0.01)
    np.testing.assert_allclose(loop.response(OMEGA), expected, rtol=1e-12)
    worn = plant_in_rpm(wear_gain=1.3).frequency_response(OMEGA)
    np.testing.assert_allclose(worn, 1.3 * plant_in_rpm().frequency_response(OMEGA), rtol=1e-12)


def test_the_rpm_factor_puts_the_crossover_of_g_c1_at_7_08_rad_s():
    """Section 2.2.1 has w_c about 7 rad/s; without 30/pi it is at 2.8."""
    assert abs(continuous_loop(LS2).response(np.array([7.08]))[0]) == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize('name', sorted(PRINTED_CONTROLLERS))
def test_state_space_and_factors_have_the_same_response(name):
    loop = continuous_loop(PRINTED_CONTROLLERS[name])
    realised = frequency_response(loop.to_state_space(), OMEGA)
    np.testing.assert_allclose(realised, loop.response(OMEGA), rtol=1e-9)


@pytest.mark.parametrize('name', sorted(PRINTED_CONTROLLERS))
def test_at_low_frequency_sampling_costs_two_periods_of_delay(name):
    """Half a period for each of the two holds and one for the delay: within 10 (w T)^2."""
    omega = np.array([0.3, 1.0, 3.0])
    controller = PRINTED_CONTROLLERS[name]
    sampled = sampled_loop(discretise_zoh(controller.to_state_space(), PERIOD_S))
    delayed = continuous_loop(controller, delay_s=2.0 * PERIOD_S).response(omega)
    error = np.abs(frequency_response(sampled, omega) / delayed - 1.0)
    assert np.all(error < 10.0 * (omega * PERIOD_S) ** 2)


def test_the_plant_brings_its_own_poles_into_the_sampled_loop():
    """P_2 and G_a: every pole of the factors is a pole of the sampled plant, log(z)/T."""
    expected = np.sort_complex(plant_in_rpm().poles)
    found = poles_rad_s(sampled_plant())
    found = np.sort_complex(found[np.isfinite(found)])
    np.testing.assert_allclose(found, expected, atol=1e-6)


def test_a_controller_of_another_period_is_refused():
    with pytest.raises(ParameterError, match='sampled at 0.02 s: discretise it at 0.01 s'):
        sampled_loop(discretise_zoh(LS2.to_state_space(), 0.02))
    with pytest.raises(ParameterError, match='controller is continuous'):
        sampled_loop(LS2.to_state_space())


def test_a_loop_with_delay_has_no_state_space():
    with refused(ParameterError, 'delay'):
        continuous_loop(LS2, delay_s=0.01).to_state_space()


def test_series_refuses_different_periods_and_several_outputs():
    lag = FactoredTransferFunction(1.0, (), (1.0,)).to_state_space()
    with pytest.raises(ParameterError, match='sampling periods None and 0.01 s differ'):
        series(lag, discretise_zoh(lag, PERIOD_S))
    two = StateSpace(lag.a, lag.b, np.ones((2, 1)), np.zeros((2, 1)))
    with pytest.raises(ParameterError, match='1 inputs and 2 outputs'):
        close_loop(two)
    with pytest.raises(ParameterError, match='1 inputs and 2 outputs'):
        frequency_response(two, OMEGA)


def test_a_loop_whose_feedthrough_is_minus_one_is_refused():
    singular = FactoredTransferFunction(-1.0, (2.0,), (1.0,)).to_state_space()
    with pytest.raises(ParameterError, match='feedthrough is -1'):
        close_loop(singular)
