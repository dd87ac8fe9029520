# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Headless runs of a gear shift: what starts when, every controller, the bag, campaigns."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from message_counts import message_counts
from refusals import refused
from samples import sampled

from ddct_bringup.bag.reader import read_bag
from ddct_bringup.batch.batchable import why_not_batchable
from ddct_bringup.batch.run_batch import run_batch
from ddct_bringup.campaign.rows import scored_headless
from ddct_bringup.run.execution import execute, simulate
from ddct_bringup.run.headless import run_headless
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.handover.laws import HANDOVERS
from ddct_controllers.registry import make_controller, own_controller_names
from ddct_plant.base.errors import ParameterError
from ddct_plant.models.driveline import LOCKED, PHASES
from ddct_plant.models.load import RoadLoad
from ddct_plant.models.static_torque import StaticTorque
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.rules.shift import gears_of
from ddct_plant.scenario.settings import RunSettings

pytestmark = pytest.mark.slow


def settings(*overrides, **values):
    scenario = load_scenario('upshift', overrides)
    return RunSettings.of(scenario, values)


@cache
def run_of(controller, *overrides, **values):
    return run_headless(settings(*overrides, **values), controller)


def feedback(run):
    """Return whether feedback is on, (N+1,)."""
    return np.array([dict(status)['feedback'] == 'on' for status in run.status])


@pytest.mark.parametrize('handover', HANDOVERS)
def test_feedback_and_reference_start_with_the_first_period_whose_share_is_one(handover):
    shift = settings('reference.shape=ramp', handover=handover)
    run = run_of('pi', 'reference.shape=ramp', handover=handover)
    start = shift.scenario.control_start_step
    first = int(np.argmax(run.handover_share == 1.0))
    assert start < first < start + 40
    assert not run.handover_share[:start].any()
    locked = int(np.argmax(run.clutch_phase == PHASES.index(LOCKED)))
    assert not feedback(run)[:first].any()
    assert feedback(run)[first:locked].all()
    assert not run.closed_loop_torque[:first].any()
    reference = run.at_tick('slip_reference')
    np.testing.assert_array_equal(reference[: first + 1], run.slip_speed[: first + 1])
    slope = shift.scenario.reference.slope_rad_s2
    np.testing.assert_allclose(np.diff(reference[first : first + 10]), -0.01 * slope)


def test_until_then_the_on_coming_clutch_gets_its_share_of_c_fol_from_zero_on():
    run, scenario = run_of('pi', handover='timed'), settings().scenario
    static = StaticTorque(gears_of(scenario).both_engaged, 'full')
    road = RoadLoad(scenario.load, scenario.vehicle)
    assert run.torque_request[0] == 0.0 == run.actuator_torque[:30].max()
    for step in (10, 35, 45):
        load = road.torque(run.vehicle_speed[step])
        speeds = run.engine_speed[step], run.primary_shaft_speed[step]
        whole = static.torque(run.engine_torque[step], load, *speeds)
        expected = run.handover_share[step] * whole
        assert run.torque_request[step] == pytest.approx(expected, rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize('controller', sampled(own_controller_names(), every=4))
def test_every_controller_shifts(controller):
    run = run_of(controller)
    assert run.clutch_phase[-1] == PHASES.index(LOCKED)
    assert abs(run.off_going_transmitted_torque[-1]) < 1e-9


def test_an_observer_does_not_take_the_torque_of_the_off_going_clutch_for_wear():
    """Without `TorquePhase` its estimate is at its lower bound, 0.5, when feedback starts."""
    run = run_of('mpc_wear')
    first = int(np.argmax(run.handover_share == 1.0))
    estimates = [
        float(dict(run.status[step])['wear_gain_estimate']) for step in (first, first + 30)
    ]
    assert 0.75 < estimates[0] < 1.05
    assert estimates[1] == pytest.approx(1.0, abs=0.01)


def test_the_request_is_corrected_by_what_the_handover_has_measured():
    run = run_of('ls8', wear_gain=0.75)
    gain, offset = 1.0 + run.on_coming_wear_deviation, run.on_coming_torque_offset
    planned = run.open_loop_torque + run.closed_loop_torque
    np.testing.assert_allclose(run.torque_request, (planned - offset) / gain, atol=1e-9)
    assert gain[-1] == pytest.approx(0.75, abs=0.05)
    assert not run.on_coming_wear_deviation[:30].any()


@pytest.mark.parametrize('wear_gain', [0.75, 1.0, 1.25])
def test_late_sensors_hardly_move_what_the_handover_measures(wear_gain):
    """V_x comes 10 ms after w_m; taken for the present one it moves the gain by 7 to 17 %."""
    late = 'sensors.engine_speed.delay_s=0.01', 'sensors.vehicle_speed.delay_s=0.02'
    run = run_of('ls8', *late, wear_gain=wear_gain)
    assert 1.0 + run.on_coming_wear_deviation[-1] == pytest.approx(wear_gain, abs=0.04)


@pytest.mark.slow
@pytest.mark.parametrize('controller', sampled(['ls8', 'pi', 'mpc3', 'least_jerk'], every=2))
def test_a_worn_clutch_shifts_as_a_new_one_with_the_handover_that_measures(controller):
    new, worn, unknown = (
        run_of(controller, wear_gain=gain, **handover)
        for gain, handover in ((1.0, {}), (0.75, {}), (0.75, {'handover': 'model'}))
    )
    far, near = (
        np.abs(run.engine_speed - new.engine_speed)[50:70].max() for run in (unknown, worn)
    )
    assert near < 0.4 * far


def test_a_shift_with_exact_sensors_is_the_same_and_its_handover_needs_no_further_one():
    run, sensed = (run_of('ls8', *more, handover='slip') for more in ((), ('sensors={}',)))
    np.testing.assert_allclose(sensed.slip_speed, run.slip_speed, atol=1e-6)


def test_a_torque_cut_reaches_the_engine_and_its_estimate_for_the_controller():
    run = run_of('pi', 'shift.torque_cut_n_m=30')
    np.testing.assert_allclose(run.engine_torque, run.torque_demand - run.torque_cut)
    assert run.torque_cut.max() == 30.0


def test_the_bag_of_a_shift_has_every_signal_setting_and_node(tmp_path: Path) -> None:
    shift = settings('shift.torque_cut_n_m=20', off_going_wear_gain=0.9, handover='slip')
    plan = RunPlan(shift, 'pi', 'headless')
    execute(plan, tmp_path)
    recording, (expected, _) = read_bag(tmp_path), simulate(plan)
    assert recording.trajectory.sha256() == expected.trajectory.sha256()
    assert recording.settings == shift
    assert recording.run_info == expected.run_info
    off_going = {name: pairs for name, pairs in recording.run_info.items() if 'off' in name}
    assert list(off_going) == ['/off_going/actuator', '/off_going/clutch']
    assert all(pairs['role'] == 'off_going' for pairs in off_going.values())
    counts = message_counts(tmp_path)
    assert counts['/off_going/run_info'] == 2
    assert counts['/clutch/handover_share'] == counts['/clutch/slip'] == 251


def test_a_shift_in_a_campaign_is_valid_step_by_step_and_in_a_batch():
    shift, limits = settings(), packaged_limits()
    controller = make_controller('pi', shift.known)
    assert not why_not_batchable(shift, controller)
    row, (same,) = scored_headless(shift, 'pi', limits), run_batch([(shift, controller)], limits)
    assert row.valid
    assert same.valid
    assert (same.state, same.why) == (row.state, row.why)


def test_an_unknown_handover_is_refused():
    with refused(ParameterError, 'handover'):
        RunPlan(settings(handover='quick'), 'pi', 'headless')


def test_the_wear_of_either_clutch_changes_its_own_torque_alone():
    new = run_of('pi', handover='timed')
    worn = run_of('pi', handover='timed', off_going_wear_gain=0.8)
    np.testing.assert_array_equal(worn.clutch_torque[:40], new.clutch_torque[:40])
    ratio = worn.off_going_clutch_torque[:40] / new.off_going_clutch_torque[:40]
    np.testing.assert_allclose(ratio, 0.8)
