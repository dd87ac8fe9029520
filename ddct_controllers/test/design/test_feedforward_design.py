# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The feedforward filter is the least-squares answer to a ramp, stable, and rings little."""

from dataclasses import replace

import numpy as np
import pytest
from other_actuators import ACTUATORS

from ddct_controllers.design.analysis.loops import sampled_plant
from ddct_controllers.design.feedforward import (
    TORQUE_RATE_WEIGHT,
    Feedforward,
    design_feedforward,
    state_at_rest,
)
from ddct_controllers.design.state_space import poles_rad_s
from ddct_controllers.linear import DiscreteFilter
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.base.units import RAD_S_PER_RPM
from ddct_plant.linear.lti import StateSpace
from ddct_plant.linear.sampling import discretise_zoh
from ddct_plant.models.actuator import PRINTED_ACTUATOR, ActuatorParameters
from ddct_plant.models.driveline_model import clutch_to_slip, engine_to_slip, load_to_slip
from ddct_plant.models.parameters import DrivelineParameters
from ddct_plant.models.printed import ACTUATOR
from ddct_plant.models.static_torque import constant_slip_torque

DRIVELINE = DrivelineParameters()
WITHOUT_DRAGS = replace(DRIVELINE, shaft_damping=0.0)
FILTER = design_feedforward(DRIVELINE, PRINTED_ACTUATOR)
EXACT = design_feedforward(DRIVELINE, PRINTED_ACTUATOR, torque_rate_weight=1e-4)
STATIC_GAINS = [constant_slip_torque(DRIVELINE, *unit) for unit in ((1.0, 0.0), (0.0, 1.0))]
STATIC = StateSpace(
    np.zeros((0, 0)), np.zeros((0, 2)), np.zeros((1, 0)), np.array([STATIC_GAINS]), PERIOD_S
)
"""Static controller with its torque C_fOL, without a model of the actuator."""
HORIZON_STEPS = 200
CORNERS = [
    replace(DRIVELINE, **{name: factor * getattr(DRIVELINE, name)})
    for name in ('engine_inertia', 'shaft_inertia', 'halfshaft_damping', 'halfshaft_stiffness')
    for factor in (0.8, 1.2)
]


def response(model: StateSpace, inputs: np.ndarray, state: np.ndarray | float = 0.0) -> np.ndarray:
    """Return the output (N,) for inputs (N, m)."""
    running = DiscreteFilter(model)
    running.reset(state)
    return np.array([running.update(*row) for row in inputs])


def slip_of_requests(actuator: ActuatorParameters, requests: np.ndarray) -> np.ndarray:
    """Return w_d (N,) in rad/s for the requests (N, 1) in N m alone, without drags."""
    return RAD_S_PER_RPM * response(sampled_plant(WITHOUT_DRAGS, actuator=actuator), requests)


def slip(
    model: StateSpace, inputs: np.ndarray, actuator: ActuatorParameters = PRINTED_ACTUATOR
) -> np.ndarray:
    """Return w_d in rad/s that remains with the filter for [C_m, C_load] (N, 2), without drags."""
    paths = (engine_to_slip(WITHOUT_DRAGS), load_to_slip(WITHOUT_DRAGS))
    disturbed = sum(
        response(discretise_zoh(path.to_state_space(), PERIOD_S), inputs[:, [column]])
        for column, path in enumerate(paths)
    )
    request = response(model, inputs)[:, np.newaxis]
    return disturbed + slip_of_requests(actuator, request)


def ramp_and_step() -> dict[str, np.ndarray]:
    """Return [C_m, C_load] with an engine torque that starts to rise, and a step of the load."""
    steps = np.arange(HORIZON_STEPS)
    nothing = np.zeros(HORIZON_STEPS)
    return {
        'engine ramp': np.column_stack([6.0 * (steps + 1.0), nothing]),
        'load step': np.column_stack([nothing, nothing + 60.0]),
    }


def least_squares_request(inputs: np.ndarray, actuator: ActuatorParameters) -> np.ndarray:
    """Return the request (N,) that minimises the cost of the design, by linear least squares."""
    impulse = np.zeros((HORIZON_STEPS, 1))
    impulse[0] = 1.0
    column = slip_of_requests(actuator, impulse)
    convolution = np.zeros((HORIZON_STEPS, HORIZON_STEPS))
    for k in range(HORIZON_STEPS):
        convolution[k:, k] = column[: HORIZON_STEPS - k]
    nothing = replace(STATIC, d=np.zeros((1, 2)))
    rate = TORQUE_RATE_WEIGHT / PERIOD_S
    difference = rate * (np.eye(HORIZON_STEPS) - np.eye(HORIZON_STEPS, k=-1))
    wanted = difference @ inputs[:, 0] * STATIC_GAINS[0]
    return np.linalg.lstsq(
        np.vstack([convolution, difference]),
        np.concatenate([-slip(nothing, inputs, actuator), wanted]),
        rcond=None,
    )[0]


@pytest.mark.parametrize('case', ['engine ramp', 'load step'])
@pytest.mark.parametrize('actuator', ACTUATORS.values(), ids=ACTUATORS)
def test_it_gives_the_least_squares_request_without_future_values(actuator, case):
    inputs = ramp_and_step()[case]
    model = design_feedforward(DRIVELINE, actuator)
    request, best = response(model, inputs), least_squares_request(inputs, actuator)
    scale = np.abs(best[:60]).max()
    # The horizon of the least squares ends after 2 s, so their last part differs.
    np.testing.assert_allclose(request[:60], best[:60], rtol=0.0, atol=1e-6 * scale)


@pytest.mark.parametrize('case', ['engine ramp', 'load step'])
def test_the_slip_returns_to_zero_although_the_torque_goes_on(case):
    left = np.abs(slip(FILTER, ramp_and_step()[case]))
    assert left[-20:].max() < 2e-3 * left.max()


def test_the_static_law_leaves_a_slip_that_grows_with_the_ramp():
    left = np.abs(slip(STATIC, ramp_and_step()['engine ramp']))
    ours = np.abs(slip(FILTER, ramp_and_step()['engine ramp']))
    assert left[-1] > 50.0 * ours.max()
    assert np.all(np.diff(left[20:]) > 0.0)


def test_the_request_has_the_sign_that_makes_p2_undo_p1():
    assert np.all(FILTER.d > 0.0)
    assert clutch_to_slip(DRIVELINE).gain < 0.0 < engine_to_slip(DRIVELINE).gain


def test_for_constant_torques_the_clutch_gets_the_static_torque():
    at_rest = FILTER.c @ np.linalg.solve(np.eye(len(FILTER.a)) - FILTER.a, FILTER.b) + FILTER.d
    clutch = at_rest[0] * ACTUATOR.frequency_response(0.0).real
    np.testing.assert_allclose(clutch, STATIC_GAINS, rtol=1e-10)


@pytest.mark.parametrize('driveline', [DRIVELINE, WITHOUT_DRAGS, *CORNERS])
def test_it_is_stable_and_its_modes_decay_within_a_second(driveline):
    poles = np.linalg.eigvals(design_feedforward(driveline, PRINTED_ACTUATOR).a)
    assert np.abs(poles).max() ** 100 < 0.01


def test_the_torsional_mode_is_damped_in_it_and_not_in_an_exact_inverse():
    def damping(model: StateSpace) -> float:
        poles = poles_rad_s(model)
        near = poles[(np.abs(poles) > 5.0) & (np.abs(poles) < 30.0) & (poles.imag > 0.0)]
        return float((-near.real / np.abs(near)).min())

    assert damping(FILTER) > 0.5
    assert damping(EXACT) < 0.16


def test_a_run_that_starts_with_torque_is_not_taken_for_a_ramp():
    constant = np.column_stack([np.full(5, 100.0), np.zeros(5)])
    started = response(FILTER, constant, state_at_rest(FILTER, 100.0))[0]
    ramping = response(FILTER, constant)[0]
    assert started < STATIC_GAINS[0] * 100.0 < ramping


def test_a_run_under_constant_torque_starts_as_if_the_torque_had_never_risen():
    """
    The first request is the direct gain of the level alone, without that of a rise.

    A filter from zero would take the first torque for a step of 250 N m within a period and
    request more; the settled request is the static one in both cases.
    """
    feedforward = Feedforward(DRIVELINE, PRINTED_ACTUATOR)
    requests = [feedforward.update(250.0, 60.0) for _ in range(400)]
    level = FILTER.d[0] + [FILTER.c[0, -1], 0.0]
    assert requests[0] == pytest.approx(level @ [250.0, 60.0], rel=1e-12)
    assert requests[0] < (FILTER.d @ [250.0, 60.0])[0] - 1.0
    assert requests[-1] == pytest.approx(np.dot(STATIC_GAINS, [250.0, 60.0]), rel=1e-4)


def test_a_driveline_without_a_filter_is_refused():
    with pytest.raises(
        DdctError, match=r'no stable filter .*: check driveline\.\* in the scenario'
    ):
        design_feedforward(replace(DRIVELINE, halfshaft_damping=1e20), PRINTED_ACTUATOR)
