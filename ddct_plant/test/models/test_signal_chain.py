# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Engine, load, clutch and actuator behave as in Section 1.4 of the thesis."""

import numpy as np
import pytest
import scipy
from other_actuators import ACTUATORS
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.models.actuator import Actuator, ActuatorParameters
from ddct_plant.models.clutch import LinearClutch
from ddct_plant.models.engine import Engine, TorqueProfile
from ddct_plant.models.load import LoadParameters, RoadLoad
from ddct_plant.models.parameters import VehicleParameters
from ddct_plant.models.printed import ACTUATOR
from ddct_plant.models.static_torque import constant_slip_torque
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.initial_state import initial_state
from ddct_plant.scenario.settings import KnownSettings, RunSettings

VEHICLE = VehicleParameters()


def test_engine_follows_its_profile_and_holds_its_ends():
    engine = Engine(TorqueProfile((0.1, 0.2, 0.4), (10.0, 30.0, 20.0)))
    torques = [engine.torque(engine.demand(step)) for step in (0, 10, 15, 20, 30, 40, 90)]
    assert torques == pytest.approx([10.0, 10.0, 20.0, 30.0, 25.0, 20.0, 20.0])


@pytest.mark.parametrize(
    ('times', 'torques', 'key'),
    [
        ((0.0, 0.0), (1.0, 2.0), 'engine.time_s'),
        ((0.0, 1.0), (1.0,), 'engine.torque_n_m'),
        ((0.0,), (float('nan'),), 'engine.torque_n_m[0]'),
        ((0.0,), (-1.0,), 'engine.torque_n_m[0]'),
        ((), (), 'engine.time_s'),
    ],
)
def test_a_bad_torque_profile_is_named(times, torques, key):
    with refused(ParameterError, key=key):
        TorqueProfile(times, torques)


def test_load_is_the_sum_of_air_rolling_and_slope():
    parameters = LoadParameters(wind_speed_m_s=2.0, slope_rad=0.1)
    speed, p = 8.0, parameters
    air = 0.5 * p.air_density_kg_m3 * p.frontal_area_m2 * p.drag_coefficient * (speed + 2.0) ** 2
    weight = VEHICLE.mass_kg * VEHICLE.gravity_m_s2
    rolling, slope = weight * p.rolling_coefficient * np.cos(0.1), weight * np.sin(0.1)
    expected = (air + rolling + slope) * VEHICLE.wheel_radius_m
    assert RoadLoad(parameters, VEHICLE).torque(speed) == pytest.approx(expected, rel=1e-12)


def test_a_tail_wind_faster_than_the_vehicle_pushes():
    calm = RoadLoad(LoadParameters(), VEHICLE).torque(0.0)
    assert RoadLoad(LoadParameters(wind_speed_m_s=-20.0), VEHICLE).torque(5.0) < calm


def test_the_linear_clutch_transmits_the_torque_times_the_wear_gain():
    assert LinearClutch(0.7).transmit([0.0, 10.0]) == [0.0, 7.0]


@pytest.mark.parametrize('wear_gain', [0.0, -1.0, 4.0, float('nan')])
def test_a_wear_gain_out_of_range_is_named(wear_gain):
    with refused(ParameterError, key='wear_gain'):
        LinearClutch(wear_gain)


def test_actuator_at_rest_stays_at_rest():
    at_rest = 100.0 * ACTUATOR.frequency_response(np.array([0.0]))[0].real
    assert at_rest == pytest.approx(100.0, rel=2e-5), 'the printed gain at rest is one'
    actuator = Actuator(100.0)
    for _ in range(20):
        assert actuator.update(100.0) == pytest.approx([at_rest] * 11, rel=1e-12)


def integrated(held_n_m, delay_ms=0, factor=1.0):
    """
    Return the torque of G_a(s / factor) at every 1 ms node, (n, 11), by a tight integration.

    Each value is held for 10 ms, the first from `delay_ms` on.
    """
    printed = ACTUATOR.to_state_space()
    a, b = factor * printed.a, factor * printed.b[:, 0]
    state, torques = np.zeros(len(a)), [0.0]
    for held in [*[0.0] * delay_ms, *np.repeat(held_n_m, 10)][: 10 * len(held_n_m)]:
        solution = scipy.integrate.solve_ivp(
            lambda _, x, held=held: a @ x + b * held,
            (0.0, 0.001),
            state,
            method='DOP853',
            rtol=1e-12,
            atol=1e-9,
            max_step=2e-4,
        )
        state = solution.y[:, -1]
        torques.append(printed.c[0] @ state)
    return np.array([torques[first : first + 11] for first in range(0, len(torques) - 1, 10)])


def test_actuator_delays_by_one_period_and_filters_by_the_printed_transfer_function():
    requests = [120.0, 40.0, 0.0, 300.0, 310.0, 90.0]
    actuator = Actuator(0.0)
    nodes = np.array([actuator.update(request) for request in requests])
    assert np.abs(nodes - integrated([0.0, *requests[:-1]])).max() < 1e-8 * max(requests)


@pytest.mark.parametrize(
    ('delay_s', 'factor'), [(0.0, 1.0), (0.003, 1.0), (0.013, 0.5), (0.029, 2.0), (0.04, 1.0)]
)
def test_another_delay_and_bandwidth_are_exact_too(delay_s, factor):
    requests = [120.0, 40.0, 0.0, 300.0, 310.0, 90.0]
    actuator = Actuator(0.0, ActuatorParameters(delay_s, factor))
    nodes = np.array([actuator.update(request) for request in requests])
    expected = integrated(requests, round(1000 * delay_s), factor)
    assert np.abs(nodes - expected).max() < 1e-8 * max(requests)
    assert Actuator(80.0, ActuatorParameters(delay_s, factor)).update(0.0)[0] == pytest.approx(
        80.0, rel=2e-5
    )


@pytest.mark.parametrize('actuator', ACTUATORS.values(), ids=ACTUATORS)
def test_the_lag_is_that_of_delay_and_dynamics_at_low_frequency(actuator):
    omega = 0.01
    phase = np.angle(actuator.transfer_function().frequency_response(np.array([omega])))[0]
    assert actuator.lag_s == pytest.approx(actuator.delay_s - phase / omega, rel=1e-4)


def test_a_delay_between_milliseconds_is_refused():
    with refused(ParameterError, key='actuator.delay_s'):
        ActuatorParameters(delay_s=0.0125)


def test_actuator_saturates_before_its_dynamics():
    """
    The request is cut off, not the torque, which undershoots zero after a fall.

    Nothing of a negative request is kept: the next positive one comes through at once.
    """
    requests = [300.0] * 10 + [-300.0] * 10 + [150.0] * 4
    actuator = Actuator(0.0)
    nodes = np.array([actuator.update(request) for request in requests])
    expected = integrated([0.0, *np.maximum(requests[:-1], 0.0)])
    assert np.abs(nodes - expected).max() < 1e-8 * max(requests)
    assert nodes.min() < -1.0


def test_actuator_starts_at_rest_on_what_it_can_give():
    actuator = Actuator(-300.0)
    assert [actuator.update(0.0) for _ in range(2)] == [[0.0] * 11] * 2


def test_a_run_downhill_starts_with_no_request_where_the_static_torque_is_negative():
    changes = ['load.slope_rad=-0.3', 'engine.torque_n_m=[0, 0]']
    settings = RunSettings(KnownSettings(load_scenario('thesis', changes)))
    start = initial_state(settings)
    driveline = settings.scenario.driveline
    assert constant_slip_torque(driveline, start.engine_torque, start.load_torque) < -1.0
    assert (start.sides[0].torque_request, start.sides[0].torque) == (0.0, 0.0)


def test_actuator_torque_is_continuous_from_period_to_period():
    actuator = Actuator(10.0)
    nodes = [actuator.update(request) for request in (200.0, 0.0, 150.0, 80.0)]
    for earlier, later in zip(nodes, nodes[1:], strict=False):
        assert later[0] == pytest.approx(earlier[-1], abs=1e-9)
