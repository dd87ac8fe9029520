# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The effect of disturbances on the slip with feedforward."""

from dataclasses import replace

import numpy as np
import pytest

from ddct_controllers.design.analysis.loops import sampled_plant
from ddct_controllers.design.feedforward import TORQUE_RATE_WEIGHT, design_feedforward
from ddct_controllers.design.state_space import frequency_response
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import rad_s_from_rpm
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.actuator import PRINTED_ACTUATOR
from ddct_plant.models.driveline_model import engine_to_slip, load_to_slip
from ddct_plant.models.static_torque import constant_slip_torque
from ddct_plant.scenario.file import load_scenario

DRIVELINE = load_scenario('thesis').driveline
FILTER = design_feedforward(DRIVELINE, PRINTED_ACTUATOR)
_STATIC_GAINS = [constant_slip_torque(DRIVELINE, *unit) for unit in ((1.0, 0.0), (0.0, 1.0))]
STATIC = StateSpace(
    np.zeros((0, 0)), np.zeros((0, 2)), np.zeros((1, 0)), np.array([_STATIC_GAINS]), PERIOD_S
)
"""Static controller's C_fOL, which has no model of the actuator."""
ENGINE, LOAD = 0, 1
PATHS = {ENGINE: engine_to_slip(DRIVELINE), LOAD: load_to_slip(DRIVELINE)}
"""P_1 from C_m and P_3 from C_load to the slip, by the filter's input."""


def with_weight(weight: float) -> StateSpace:
    """Return the filter for another price of torque beyond the static law."""
    return design_feedforward(DRIVELINE, PRINTED_ACTUATOR, torque_rate_weight=weight)


def residual(model: StateSpace, column: int, omega: np.ndarray) -> np.ndarray:
    """
    Return (P_1 + P_2 G_a F_1) / P_1, or the same with P_3 and F_2: the shape of `omega` in rad/s.

    F_1 = -C_1 is the filter's path from C_m. Everything is sampled at 10 ms, with hold and
    actuator delay, and the driveline has its drags. 0 is full compensation, 1 none at all.
    """
    path = replace(model, b=model.b[:, [column]], d=model.d[:, [column]])
    uncompensated = discretise_zoh(PATHS[column].to_state_space(), PERIOD_S)
    compensation = rad_s_from_rpm(frequency_response(sampled_plant(DRIVELINE), omega))
    compensation = compensation * frequency_response(path, omega)
    return 1.0 + compensation / frequency_response(uncompensated, omega)


def test_it_compensates_the_engine_torque_better_than_the_static_law_up_to_3_3_hz():
    omega = 2.0 * np.pi * np.append(np.geomspace(0.05, 3.3, 50), 3.4)
    ours = np.abs(residual(FILTER, ENGINE, omega))
    static = np.abs(residual(STATIC, ENGINE, omega))
    assert np.all(ours[:-1] < static[:-1])
    assert ours[-1] > static[-1]
    assert ours[omega < 2.0 * np.pi].max() < 0.03


def test_it_compensates_the_load_up_to_a_third_of_a_hertz():
    omega = 2.0 * np.pi * np.geomspace(0.05, 0.3, 20)
    assert np.abs(residual(FILTER, LOAD, omega)).max() < 0.05


def test_without_a_filter_the_residual_is_one():
    nothing = replace(STATIC, d=np.zeros((1, 2)))
    for column in (ENGINE, LOAD):
        found = residual(nothing, column, np.array([1.0, 10.0]))
        np.testing.assert_array_equal(found, [1.0, 1.0])


def test_the_residuals_of_the_weight_that_we_take_are_below_those_of_nearly_exact_inversion():
    omega = 2.0 * np.pi * np.array([0.05, 0.5, 2.0])
    exact = np.abs(residual(with_weight(1e-4), ENGINE, omega))
    ours = np.abs(residual(with_weight(TORQUE_RATE_WEIGHT), ENGINE, omega))
    assert np.all(exact <= ours)


@pytest.mark.parametrize(('weight', 'at_once_n_m'), [(TORQUE_RATE_WEIGHT, 1.20), (1e-4, 2.08)])
def test_a_step_of_engine_torque_moves_the_request_at_once(weight: float, at_once_n_m: float):
    assert with_weight(weight).d[0, 0] == pytest.approx(at_once_n_m, abs=5e-3)
    assert constant_slip_torque(DRIVELINE, 1.0, 0.0) == pytest.approx(0.88, abs=5e-3)
