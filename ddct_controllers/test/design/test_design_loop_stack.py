# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A stack of systems gives each one what it gives alone, whatever stands beside it."""

import numpy as np
import pytest

from ddct_controllers.design.analysis.driveline_mode import locked_driveline_zeros
from ddct_controllers.design.analysis.loops import IDENTIFIED_DRIVELINE, sampled_plant
from ddct_controllers.design.analysis.worst_corner import plant_corners
from ddct_controllers.design.loop_stack import LoopStack
from ddct_controllers.design.state_space import close_loop, frequency_response, scaled, series
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.actuator import ActuatorParameters
from ddct_plant.models.driveline_model import clutch_to_slip, driveline_matrices

CONTROLLER = discretise_zoh(PRINTED_CONTROLLERS['ls8'].to_state_space(), PERIOD_S)
OMEGA = np.geomspace(1e-3, np.pi / PERIOD_S, 40)
GAINS = np.array([0.7, 1.0, 1.3])
PARAMETERS = plant_corners().parameters


def plants(places: slice, delay_s: float = 0.014) -> LoopStack:
    actuator = ActuatorParameters(delay_s=delay_s)
    paths = [driveline_matrices(p).path('clutch_torque', 'slip_speed') for p in PARAMETERS[places]]
    return (
        LoopStack.joined(paths).behind(actuator.dynamics()).behind_delay(actuator.delay_substeps)
    )


@pytest.mark.parametrize('count', [1, 2, 3, 33])
def test_a_system_has_the_same_bits_in_a_stack_of_any_size(count):
    whole, part = (plants(slice(0, n)).behind(CONTROLLER) for n in (128, count))
    for every, some in (
        (whole.a, part.a),
        (whole.b, part.b),
        (whole.c, part.c),
        (whole.d, part.d),
        (whole.closed(GAINS), part.closed(GAINS)),
        (whole.responses(OMEGA), part.responses(OMEGA)),
    ):
        np.testing.assert_array_equal(every[:count], some)


@pytest.mark.parametrize('delay_s', [0.0, 0.004, 0.01, 0.023])
def test_sampled_plants_of_a_stack_are_those_one_by_one(delay_s):
    actuator, stack = ActuatorParameters(delay_s=delay_s), plants(slice(0, 8), delay_s)
    for place, parameters in enumerate(PARAMETERS[:8]):
        plant = sampled_plant(parameters, actuator=actuator)
        rpm = stack.sampled(place)
        scale = np.pi / 30.0
        np.testing.assert_allclose(rpm.a, plant.a, rtol=1e-12, atol=1e-12 * np.abs(plant.a).max())
        np.testing.assert_allclose(rpm.b, plant.b, rtol=1e-12)
        np.testing.assert_allclose(rpm.c, plant.c * scale, rtol=1e-12)


def test_closed_loops_and_responses_are_those_one_by_one():
    stack = plants(slice(0, 8))
    loops, responses = stack.behind(CONTROLLER), stack.responses(OMEGA)
    for place, closed in enumerate(loops.closed(GAINS)):
        loop = series(CONTROLLER, stack.sampled(place))
        for gain, matrix in zip(GAINS, closed, strict=True):
            np.testing.assert_allclose(matrix, close_loop(scaled(loop, gain)).a, rtol=1e-12)
        alone = frequency_response(stack.sampled(place), OMEGA)
        np.testing.assert_allclose(responses[place], alone, rtol=1e-9)
        product = loops.responses(OMEGA)[place] / frequency_response(CONTROLLER, OMEGA)
        np.testing.assert_allclose(product, alone, rtol=1e-9)


def test_zeros_of_the_locked_driveline_are_those_of_its_factors():
    corners = plant_corners()
    for zero, parameters in zip(corners.zeros, corners.parameters, strict=True):
        (upper,) = (each for each in clutch_to_slip(parameters).zeros if each.imag > 0.0)
        assert zero == pytest.approx(upper, rel=1e-9)


def test_zeros_of_a_driveline_that_does_not_oscillate_are_nan():
    damped = IDENTIFIED_DRIVELINE.with_values(halfshaft_damping=5000.0)
    path = driveline_matrices(damped).path('clutch_torque', 'slip_speed')
    assert np.isnan(locked_driveline_zeros(LoopStack.joined([path]))).all()
