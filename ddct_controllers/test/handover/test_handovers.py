# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The handovers of a shift: ramps, the torque balance, slip under feedback, and the torque cut."""

import itertools
from dataclasses import replace
from typing import Any

import pytest
from handed_over import flare, shift, tie_up_work
from other_actuators import ACTUATORS, SLOW
from refusals import refused
from samples import sampled
from shifts import HANDOVER_S, shift_settings

from ddct_controllers.handover.interface import (
    MARGIN,
    HandoverMeasurement,
    HandoverModel,
)
from ddct_controllers.handover.laws import HANDOVERS, SEARCH_FALL, make_handover
from ddct_controllers.handover.torque_phase import TorquePhase
from ddct_controllers.interface import Measurement
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.models.actuator import PRINTED_ACTUATOR, Actuator
from ddct_plant.models.driveline import LOCKED, PHASES
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.initial_state import initial_request
from ddct_plant.scenario.rules.shift import gears_of
from ddct_plant.scenario.settings import KnownSettings, RunSettings
from ddct_plant.shift.balance import OffGoingBalance
from ddct_plant.shift.roles import OFF_GOING

START, STEPS = 30, round(HANDOVER_S / PERIOD_S)
COLD = ['upshift', 'upshift_light', 'upshift_full', 'upshift_2_3']


def with_actuator(name, actuator, **keys):
    """Return the settings of a packaged shift with an actuator that all know."""
    settings = shift_settings(name, **keys)
    scenario = replace(settings.scenario, actuator=actuator)
    return replace(settings, known=replace(settings.known, scenario=scenario))


@pytest.mark.parametrize('name', HANDOVERS)
def test_before_the_shift_the_off_going_clutch_stays_locked(name):
    ticks = shift(shift_settings('upshift'), name)
    for tick in ticks[: START + 1]:
        assert tick.command.share == tick.command.torque_cut == 0.0
        assert PHASES[int(tick.outputs.off_going.clutch_phase)] == LOCKED
        carried = tick.outputs.off_going.transmitted_torque
        assert tick.command.off_going_request > 1.4 * carried + 19.0
    assert ticks[0].command.off_going_request == pytest.approx(
        initial_request(shift_settings('upshift'), OFF_GOING), rel=1e-9
    )


@pytest.mark.parametrize(
    ('wear_gain', 'scenario', 'name'),
    sampled(itertools.product([0.8, 1.2], COLD, HANDOVERS), every=3),
)
def test_after_the_handover_the_share_is_one_and_the_off_going_clutch_opens(
    name, scenario, wear_gain
):
    ticks = shift(shift_settings(scenario, wear_gain), name)
    shares = [tick.command.share for tick in ticks]
    assert shares == sorted(shares)
    first = shares.index(1.0)
    assert first >= START + STEPS
    assert all(tick.command.off_going_request == 0.0 for tick in ticks[first:])
    assert ticks[-1].outputs.off_going.transmitted_torque == pytest.approx(0.0, abs=1e-6)
    assert tie_up_work(ticks) < (75.0 if name in ('timed', 'adaptive') else 50.0)


MOST_FLARE = [('timed', 5.0), ('model', 5.0), ('adaptive', 5.0), ('slip', 15.0)]


@pytest.mark.parametrize(
    ('scenario', 'handover'), sampled(itertools.product(COLD, MOST_FLARE), every=3)
)
def test_the_engine_hardly_runs_ahead_with_a_clutch_as_expected(scenario, handover):
    name, most = handover
    assert flare(shift(shift_settings(scenario), name)) < most


def test_the_timed_handover_follows_its_ramps():
    settings = shift_settings('upshift', handover_s=0.1)
    ticks = shift(settings, 'timed')[START : START + 11]
    held = ticks[0].command.off_going_request
    for step, tick in enumerate(ticks):
        assert tick.command.share == pytest.approx(step / 10)
        assert tick.command.off_going_request == pytest.approx(held * (1.0 - step / 10))


def test_hot_clutches_tie_up_where_no_slip_is_sought_and_hardly_where_it_is():
    """Both carry 18 N m more than requested, which only the slip can show."""
    hot = shift_settings('upshift_hot')
    assert min(tie_up_work(shift(hot, name)) for name in ('timed', 'model')) > 100.0
    sought = shift(hot, 'slip')
    assert tie_up_work(sought) < 5.0
    assert flare(sought) < 5.0


def test_the_model_handover_requests_more_than_the_clutch_carries_by_its_margin():
    """The actuators delay both requests alike: the torque is that of 40 ms before."""
    ticks = shift(shift_settings('upshift', handover_s=1.0), 'model')
    for step in range(START + 30, START + 70):
        carried = ticks[step + 4].outputs.off_going.transmitted_torque
        assert ticks[step].command.off_going_request == pytest.approx(MARGIN * carried, abs=4.0)


def test_the_slip_handover_keeps_the_clutch_at_its_slip_while_it_carries_torque():
    ticks = shift(shift_settings('upshift', handover_s=0.8, handover_slip_rad_s=5.0), 'slip')
    slips = [tick.outputs.off_going.slip_speed for tick in ticks[START + 40 : START + 75]]
    assert max(slips) < 10.0
    assert min(slips) > 2.0


@pytest.mark.parametrize(
    ('actuator', 'name'), sampled(itertools.product(ACTUATORS.values(), HANDOVERS), every=3)
)
def test_with_every_actuator_that_it_knows_a_handover_neither_flares_nor_ties_up(actuator, name):
    ticks = shift(with_actuator('upshift', actuator), name)
    assert flare(ticks) < 9.0
    assert tie_up_work(ticks) < 75.0


@pytest.mark.parametrize('name', ['slip', 'adaptive'])
def test_a_handover_that_does_not_know_its_slow_actuator_flares_or_ties_up(name):
    """Its law is that of the known settings, so the true actuator has not reached it."""
    law = make_handover(shift_settings('upshift', handover=name).known)
    ticks = shift(with_actuator('upshift', SLOW), name, law=law)
    assert flare(ticks) > 10.5 or tie_up_work(ticks) > 110.0


@pytest.mark.parametrize('actuator', ACTUATORS.values(), ids=ACTUATORS)
def test_the_slip_handover_falls_as_much_in_the_lag_of_every_actuator(actuator):
    """The request before the clutch slips is the balance less a share that grows with time."""
    settings = with_actuator('upshift', actuator)
    ticks = shift(settings, 'slip')
    model = HandoverModel(settings.known)
    shares = []
    for step in (START + 1, START + 3):
        now = ticks[step].outputs
        measured = HandoverMeasurement(
            step, 100.0, now.engine_speed, now.slip_speed, 0.0, now.vehicle_speed
        )
        shares.append(ticks[step].command.off_going_request / model.off_going(measured))
    rate = (shares[0] - shares[1]) / (2.0 * PERIOD_S)
    assert rate * actuator.lag_s == pytest.approx(SEARCH_FALL, rel=0.02)


@pytest.mark.parametrize('actuator', ACTUATORS.values(), ids=ACTUATORS)
def test_the_torque_phase_has_the_torque_of_the_known_actuator(actuator):
    settings = with_actuator('upshift', actuator)
    phase, plant = TorquePhase(settings.known), Actuator(0.0, actuator)
    balance = OffGoingBalance.of(gears_of(settings.scenario))
    for step, open_loop in enumerate((0.0, 20.0, 40.0, 60.0, 80.0, 100.0)):
        now = Measurement(step, 270.0, 160.0, 17.0, 5.5, 100.0, [0.0], [0.0], 60.0, open_loop)
        carried = balance.torque(100.0, 60.0, 270.0, plant.mean_torque(open_loop))
        found = phase.measured(now)
        assert found.engine_torque == pytest.approx(100.0 - carried)
        assert found.load_torque == pytest.approx(60.0 - balance.off_going.wheel_torque(carried))


@pytest.mark.parametrize(('actuator', 'rise_s'), [(PRINTED_ACTUATOR, 0.1), (SLOW, 2 * SLOW.lag_s)])
def test_the_torque_cut_rises_in_the_inertia_phase_and_fades_to_the_lock(actuator, rise_s):
    settings = with_actuator('upshift', actuator, torque_cut_n_m=40.0)
    ticks = shift(settings, 'timed', 1.9)
    periods = 0
    for tick in ticks:
        periods += tick.command.share == 1.0
        share_of_cut = min(
            max(tick.outputs.slip_speed, 0.0) / 30.0, periods * PERIOD_S / rise_s, 1.0
        )
        assert tick.command.torque_cut == pytest.approx(40.0 * share_of_cut)
    cuts = [tick.command.torque_cut for tick in ticks]
    assert max(cuts) == 40.0
    assert any(0.0 < cut < 39.0 for cut in cuts)
    assert cuts[-1] == pytest.approx(0.0, abs=1e-6)
    after = ticks[cuts.index(40.0) + 1].outputs
    assert after.joint_effort.engine == 60.0


def test_a_handover_expects_what_the_locked_clutch_carries():
    settings = shift_settings('upshift')
    ticks = shift(settings, 'timed')
    now = ticks[START].outputs
    expected = HandoverModel(settings).off_going(
        HandoverMeasurement(START, 100.0, now.engine_speed, now.slip_speed, 0.0, now.vehicle_speed)
    )
    assert now.off_going.transmitted_torque == pytest.approx(expected, abs=0.05)


def test_an_unknown_handover_is_refused():
    with refused(ParameterError, 'handover'):
        make_handover(replace(shift_settings('upshift').known, handover='quick'))


def test_a_handover_is_not_made_from_the_true_settings_of_a_run() -> None:
    true: Any = RunSettings(KnownSettings(load_scenario('upshift')))
    with refused(ParameterError, 'settings'):
        make_handover(true)
