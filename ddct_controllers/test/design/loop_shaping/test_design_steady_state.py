# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The number of integrators follows from the final-value theorem, and the loop obeys it."""

import math

import numpy as np
import pytest
from refusals import refused

from ddct_controllers.design.analysis.loops import continuous_loop, plant_in_rpm
from ddct_controllers.design.loop_shaping.design import (
    integrators,
    poles_at_zero,
    required_integrators,
)
from ddct_controllers.printed import PRINTED_CONTROLLERS
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.units import RPM_PER_RAD_S
from ddct_plant.linear.lti import FactoredTransferFunction
from ddct_plant.models.driveline_model import engine_to_slip, load_to_slip
from ddct_plant.models.parameters import DrivelineParameters

DRIVELINE = DrivelineParameters()
PLANT = plant_in_rpm(DRIVELINE)
ENGINE, LOAD = engine_to_slip(DRIVELINE), load_to_slip(DRIVELINE)


def steady_state_error(
    loop: FactoredTransferFunction,
    disturbance_path: FactoredTransferFunction,
    disturbance_order: int = 0,
) -> float:
    """
    Return |e| at t = inf for the disturbance 1 / s^(h + 1): zero, a finite value or infinity.

    It is the limit of |path / L| / s^h at s = 0, for a stable loop that integrates.
    """
    order = poles_at_zero(loop) - poles_at_zero(disturbance_path) - disturbance_order
    if order != 0:
        return 0.0 if order > 0 else math.inf
    return abs(_leading_coefficient(disturbance_path) / _leading_coefficient(loop))


def _leading_coefficient(transfer_function: FactoredTransferFunction) -> float:
    """Return G(s) s^q at s = 0, q being the number of poles there."""
    zeros, poles = transfer_function.zeros, transfer_function.poles
    product = np.prod(-zeros[zeros != 0.0]) / np.prod(-poles[poles != 0.0])
    return float((transfer_function.gain * product).real)


def test_a_step_of_engine_torque_needs_one_integrator_as_in_section_2_2():
    assert poles_at_zero(PLANT) == 1
    assert required_integrators(PLANT, ENGINE) == 1


@pytest.mark.parametrize(
    ('path', 'order', 'expected'), [(ENGINE, 1, 2), (ENGINE, 2, 3), (LOAD, 0, 0), (LOAD, 1, 1)]
)
def test_higher_disturbances_need_more_and_the_load_one_less(path, order, expected):
    """P_3 has no pole at 0: for C_load alone the plant's own integrator is enough."""
    assert required_integrators(PLANT, path, order) == expected


def test_engine_damping_takes_the_pole_from_plant_and_path_alike():
    damped = DrivelineParameters(engine_damping=0.05)
    assert required_integrators(plant_in_rpm(damped), engine_to_slip(damped)) == 1


def test_ls8_leaves_no_error_after_a_step_a_finite_one_after_a_ramp():
    loop = continuous_loop(PRINTED_CONTROLLERS['ls8']).transfer_function
    assert steady_state_error(loop, ENGINE) == 0.0
    assert 0.0 < steady_state_error(loop, ENGINE, 1) < math.inf
    assert steady_state_error(loop, ENGINE, 2) == math.inf


def test_without_integrator_the_error_is_that_of_the_engine_torque_over_the_gain():
    """w_d = P_1 C_m / (1 + K G_a P_2) -> C_m / |K|, but for the rounding of G_a's print."""
    loop = continuous_loop(integrators(-0.5, 0)).transfer_function
    in_rpm = ENGINE * FactoredTransferFunction(RPM_PER_RAD_S)
    assert steady_state_error(loop, in_rpm) == pytest.approx(2.0, rel=2e-5)


def test_a_negative_disturbance_order_is_refused():
    with refused(ParameterError, 'disturbance order'):
        required_integrators(PLANT, ENGINE, -1)
