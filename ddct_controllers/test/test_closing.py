# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The closing stage: when a clutch counts as locked, its request then, and when it opens."""

from dataclasses import replace

import numpy as np
import pytest

from ddct_controllers.architecture import make_architecture
from ddct_controllers.closing import ClosingStage
from ddct_controllers.interface import Command, Controller, Measurement
from ddct_plant.models.load import RoadLoad
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.scenario.choices.settings import ARCHITECTURES
from ddct_plant.scenario.control import ClosingParameters
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SETTINGS = RunSettings(KnownSettings(load_scenario('thesis_sticking', ['closing={}'])))
START = SETTINGS.scenario.control_start_step
P = ClosingParameters()
MOST = P.most_request(SETTINGS.scenario.friction)
DWELL = 10
"""Number of periods of the default dwell time."""
ALIKE = Measurement(
    step=START,
    engine_speed=180.0,
    shaft_speed=180.0,
    wheel_speed=19.0,
    vehicle_speed=6.0,
    engine_torque=100.0,
    slip_reference=[0.0],
    slip_reference_rate=[0.0],
)
APART = replace(ALIKE, engine_speed=180.0 + 1.01 * P.slip_band_rad_s)
STATIC = StaticTorque(SETTINGS.scenario.driveline, SETTINGS.scenario.equilibrium)


class ConstantCommand(Controller):
    def __init__(self, torque=0.0, deviation=None):
        self.torque, self.deviation = torque, deviation
        self.commands_engine = deviation is not None
        self.open_loop_torques = []
        """Torque in N m that the architecture adds, in each period without feedback."""

    def reset(self):
        pass

    def hold(self, measurement):
        self.open_loop_torques.append(measurement.open_loop_torque)

    def update(self, measurement):
        engine = None if self.deviation is None else measurement.engine_torque + self.deviation
        return Command(self.torque, engine_torque=engine)


def carried(measurement):
    scenario = SETTINGS.scenario
    load = RoadLoad(scenario.load, scenario.vehicle).torque(measurement.vehicle_speed)
    return STATIC.torque(
        measurement.engine_torque, load, measurement.engine_speed, measurement.shaft_speed
    )


def answers(measurements, controller=None, settings=SETTINGS):
    """Return the requests of successive periods from control start on."""
    architecture = make_architecture(settings, controller or ConstantCommand())
    steps = enumerate(measurements, START)
    return [architecture.update(replace(each, step=step)) for step, each in steps]


def states(requests):
    return [dict(request.status)['closing'] for request in requests]


def torques(requests):
    return np.array([request.torque for request in requests])


def test_it_closes_once_both_were_within_the_band_for_the_dwell_time():
    assert states(answers([ALIKE] * (DWELL + 1))) == ['open'] * DWELL + ['closing']
    interrupted = [*[ALIKE] * DWELL, APART, *[ALIKE] * DWELL]
    assert set(states(answers(interrupted))) == {'open'}


@pytest.mark.parametrize(
    'change', [{'slip_reference': [5.0]}, {'slip_reference': [-5.0]}, {'engine_speed': 178.0}]
)
def test_a_reference_or_a_slip_beyond_the_band_keeps_it_open(change):
    assert set(states(answers([replace(ALIKE, **change)] * 30))) == {'open'}


def test_a_slip_that_runs_through_zero_is_no_lock():
    crossing = [replace(ALIKE, engine_speed=180.0 + 0.21 * (15 - k)) for k in range(30)]
    assert set(states(answers(crossing))) == {'open'}


def test_noise_of_encoders_neither_keeps_it_open_nor_opens_it():
    noise = np.random.default_rng(1).normal(0.0, 0.1, (20000, 2))
    noisy = [replace(ALIKE, engine_speed=180 + m, shaft_speed=180 + p) for m, p in noise]
    assert set(states(answers(noisy))[DWELL:]) == {'closing', 'closed'}


def test_it_waits_for_control_to_start():
    architecture = make_architecture(SETTINGS.known, ConstantCommand())
    before = [architecture.update(replace(ALIKE, step=step)) for step in range(START)]
    assert set(states(before)) == {'open'}


@pytest.mark.parametrize('own', [30.0, -30.0])
def test_the_request_leaves_without_a_jump_and_rises_along_the_ramp(own):
    controller = ConstantCommand(own)
    found = torques(answers([ALIKE] * 60, controller))
    level = carried(ALIKE)
    per_period = P.ramp_n_m_s * 0.01
    assert found[:DWELL] == pytest.approx(level + own)
    assert np.diff(found)[DWELL - 1] == pytest.approx(per_period)
    assert (np.abs(np.diff(found)) <= per_period + 1e-9).all()
    assert found[-1] == pytest.approx(P.margin * level + P.reserve_n_m)
    assert controller.open_loop_torques == pytest.approx(found[DWELL:]), 'whole request'


def test_the_margin_may_come_slowly():
    scenario = load_scenario('thesis_sticking', ['closing.ramp_n_m_s=0.5'])
    found = torques(answers([ALIKE] * 20, settings=RunSettings(KnownSettings(scenario))))
    assert np.diff(found)[DWELL:] == pytest.approx(0.005, abs=1e-9)


def test_the_margin_follows_the_engine_torque_at_once():
    rising = [*[ALIKE] * 60, *[replace(ALIKE, engine_torque=200.0)] * 60]
    found = torques(answers(rising))
    more = carried(rising[-1]) - carried(ALIKE)
    assert found[60] - found[59] == pytest.approx(more + P.ramp_n_m_s * 0.01)
    assert found[-1] == pytest.approx(P.margin * carried(rising[-1]) + P.reserve_n_m)


def test_the_clutch_stays_locked_with_a_dragged_engine_too():
    dragged = replace(ALIKE, engine_torque=-60.0)
    assert carried(dragged) < 0.0
    found = answers([dragged] * 60)[-1].torque
    assert found == pytest.approx(-P.margin * carried(dragged) + P.reserve_n_m)


@pytest.mark.parametrize('engine_torque', [400.0, 900.0])
def test_it_requests_no_more_than_the_clutch_has_unless_c_fol_does(engine_torque):
    loaded = replace(ALIKE, engine_torque=engine_torque)
    level = carried(loaded)
    found = answers([ALIKE] * 30 + [loaded] * 90)[-1].torque
    assert found == pytest.approx(max(level, MOST))


@pytest.mark.parametrize('engine_torque', [400.0, 900.0])
def test_it_stays_closed_where_c_fol_is_more_than_the_stage_may_request(engine_torque):
    """Feedback may not lock a clutch with as much, but the engine may need it of a locked one."""
    loaded = replace(ALIKE, engine_torque=engine_torque)
    controller = ConstantCommand(-40.0)
    found = answers([ALIKE] * 30 + [loaded] * 90, controller)
    assert (found[-1].torque > MOST) == (engine_torque == 900.0)
    assert set(states(found)[DWELL:]) <= {'closing', 'closed'}
    assert {dict(each.status)['feedback'] for each in found[DWELL:]} == {'held off'}
    assert len(controller.open_loop_torques) == 120 - DWELL


def test_it_never_falls_below_the_torque_with_which_feedback_had_locked_a_worn_clutch():
    own = 1.0 * carried(ALIKE)
    assert own > (P.margin - 1.0) * carried(ALIKE) + P.reserve_n_m
    assert torques(answers([ALIKE] * 60, ConstantCommand(own))) == pytest.approx(2.0 * own)


def test_feedback_that_requests_more_than_the_stage_may_stays_on():
    controller = ConstantCommand(MOST)
    assert set(states(answers([ALIKE] * 60, controller))) == {'open'}
    assert controller.open_loop_torques == []


def test_slip_opens_it_and_its_torque_fades_while_feedback_acts():
    own = -5.0
    controller = ConstantCommand(own)
    found = answers([*[ALIKE] * 60, *[APART] * 60], controller)
    assert states(found)[59:61] == ['closed', 'opening']
    assert states(found)[-1] == 'open'
    assert [dict(each.status)['feedback'] for each in found[59:61]] == ['held off', 'on']
    closed, opening = torques(found[:60]), torques(found[60:])
    per_period = P.ramp_n_m_s * 0.01
    assert opening[0] - closed[-1] == pytest.approx(own - per_period, abs=0.1)
    assert np.diff(opening).min() == pytest.approx(-per_period)
    assert opening[-1] == pytest.approx(carried(APART) + own)
    assert len(controller.open_loop_torques) == 60 - DWELL


@pytest.mark.parametrize('name', ARCHITECTURES)
def test_the_closed_request_is_the_same_in_every_architecture(name):
    settings = replace(SETTINGS.known, architecture=name)
    found = answers([ALIKE] * 200, ConstantCommand(carried(ALIKE)), settings)[-1]
    assert dict(found.status)['closing'] == 'closed'
    assert found.open_loop == found.torque
    assert 0.0 < found.closing <= found.open_loop
    assert found.torque >= P.margin * carried(ALIKE) + P.reserve_n_m - 1e-9


def test_the_engine_is_handed_back_to_the_driver_without_a_step():
    found = answers([ALIKE] * 60, ConstantCommand(0.0, deviation=-60.0))
    engine = np.array([request.engine_torque for request in found])
    assert engine[:DWELL] == pytest.approx(40.0)
    assert np.diff(engine)[DWELL - 1 : DWELL + 29] == pytest.approx(2.0)
    assert engine[DWELL + 29 :] == pytest.approx(100.0)


def test_without_the_section_no_torque_and_no_status_is_added():
    plain = replace(SETTINGS.known, scenario=load_scenario('thesis'))
    found = answers([ALIKE] * 60, settings=plain)
    assert {request.torque for request in found} == {carried(ALIKE)}
    assert not any(key.startswith('closing') for key, _ in found[-1].status)


def test_a_dwell_and_a_fade_of_zero_act_at_once():
    stage = ClosingStage(ClosingParameters(dwell_s=0.0, engine_fade_s=0.0), STATIC, MOST)
    stage.update(ALIKE, 0.0, 90.0, 90.0, feedback_on=True)
    assert (stage.closed, stage.engine_share) == (True, 0.0)
