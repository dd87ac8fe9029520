# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Floors of the inertia phase of a gear shift contain the runs with the same handover."""

import numpy as np
import pytest
from refusals import refused
from samples import sampled
from scored_metrics import SCORED
from shift_cases import case_with, compared_starts, settings_of

from ddct_bringup.floor import computed_floor
from ddct_bringup.floor.cache import digest_of
from ddct_bringup.floor.case import case_at, case_of_run
from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.floor import floor_of, floors_of_run
from ddct_bringup.floor.lock import lock_of
from ddct_bringup.floor.metric_units import METRICS
from ddct_bringup.floor.point import point_of
from ddct_bringup.floor.values import value_of
from ddct_bringup.metrics.shift.course import ShiftCourse
from ddct_bringup.metrics.signals.vibration import jerk
from ddct_bringup.run.execution import recording_in_memory
from ddct_bringup.run.headless import run_headless
from ddct_bringup.scores.scoring import score_run
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.base.errors import ParameterError

RULES = packaged_limits().rules
pytestmark = pytest.mark.slow
RUNS = (
    ('upshift', 'model', 'mpc1', ()),
    ('upshift', 'timed', 'ls3', ()),
    ('upshift', 'slip', 'mpc3', ('actuator.delay_s=0.013',)),
    ('upshift_light', 'model', 'mpc_wear', ()),
    ('upshift', 'timed', 'ls8', ('shift.torque_cut_n_m=40', 'sensors={}')),
    ('upshift_2_3', 'model', 'mpc_offset_free', ()),
    ('upshift_full', 'timed', 'pi', ()),
    ('upshift_hot', 'slip', 'ls8', ()),
)
"""Runs whose off-going clutch sticks, flares, slips back and locks again, or is open at once."""


@pytest.mark.parametrize(
    ('scenario', 'handover', 'controller', 'overrides'), sampled(RUNS, every=2)
)
def test_a_shift_is_a_point_of_the_program_that_bounds_it(
    scenario, handover, controller, overrides
):
    settings = settings_of(scenario, overrides, handover=handover)
    run = run_headless(settings, controller)
    case = case_with(settings, run)
    point = point_of(case, run)
    assert np.abs(case.motion.acceleration @ point - run.vehicle_accel).max() < 1e-10
    assert np.abs(case.motion.torsion_speed @ point - run.driveshaft_speed).max() < 1e-10
    rows, limits = case.inequalities.rows, case.inequalities.limits
    assert np.max(rows @ point - limits) < 1e-8
    assert np.max(np.abs(case.equations @ point)) < 1e-8
    assert np.all(case.motion.columns.low - point[1:] <= 1e-9)
    assert np.all(point[1:] - case.motion.columns.high <= 1e-9)


def test_controllers_of_the_clutch_reach_the_inertia_phase_in_one_state():
    """All of them do, after each handover: tests/nightly/floor."""
    names = ('pi', 'mpc3', 'mpc4', 'least_jerk')
    assert compared_starts('timed', names) == 3, 'one of them commands the engine'


def test_the_torque_of_the_off_going_clutch_depends_on_the_controller():
    """So it is a variable: with `mpc1` its sign changes 40 ms after the start, with `pi` not."""
    settings = settings_of(handover='timed')
    means = []
    for controller in ('pi', 'mpc1'):
        run = run_headless(settings, controller)
        case = case_with(settings, run)
        means.append(point_of(case, run)[case.motion.columns.of_shapes(3).start])
    assert means[0] > 2.0
    assert means[1] < -1.0


@pytest.mark.parametrize(
    ('scenario', 'handover', 'controller'),
    [('upshift_hot', 'slip', 'mpc_preview')],
)
def test_no_metric_of_a_shift_is_below_its_floor(scenario, handover, controller):
    settings = settings_of(scenario, handover=handover)
    run = run_headless(settings, controller)
    for metric, over in floors_of_run(settings, list(METRICS), run).items():
        assert over.value >= over.floor.least, metric


def test_the_values_are_those_of_scores():
    settings = settings_of()
    run = run_headless(settings, 'ls8')
    entry = score_run(recording_in_memory(settings, 'ls8', run), 'ls8', packaged_limits(), None)
    start = control_start(settings)
    for metric, key in SCORED.items():
        value = value_of(settings, metric, run, start.scored_from)
        assert value == pytest.approx(entry.metrics[key], rel=1e-9), metric


def test_lock_times_count_as_the_inertia_phase_does():
    settings = settings_of(handover='slip')
    run = run_headless(settings, 'ls8')
    course = ShiftCourse(run, settings.scenario.control_start_step)
    lock = lock_of(run, control_start(settings).step, RULES)
    assert lock.time_s == pytest.approx(course.inertia_phase_s, abs=1e-12)


@pytest.mark.parametrize(
    ('handover', 'time_s', 'gap'),
    sampled([('slip', 0.42, 5.0), ('model', 0.42, 15.0), ('timed', 0.5, 30.0)], every=2),
)
def test_the_least_peak_jerk_is_nearly_attained_by_a_shift(handover, time_s, gap):
    """The less the off-going clutch still carries, the smaller the gap."""
    floor = floor_of(settings_of(handover=handover), 'peak_jerk', time_s)
    assert 0.0 <= floor.gap <= gap


def test_the_jerk_of_the_torque_phase_is_part_of_the_least():
    settings = settings_of(handover='model')
    start, run = control_start(settings), run_headless(settings, 'pi')
    common = np.abs(jerk(run.vehicle_accel)[start.scored_from : start.step - 1]).max()
    assert common > 2.0
    assert floor_of(settings, 'peak_jerk', 0.9).least >= common - 1e-6


@pytest.mark.parametrize('handover', sampled(['adaptive', 'model'], every=2))
def test_a_pair_of_the_package_is_near_the_least_of_the_clutch_alone(handover):
    """It commands the engine too, so it has no floor of its own."""
    settings = settings_of(handover=handover)
    run = run_headless(settings, 'torque_estimator')
    start = control_start(settings)
    assert floors_of_run(settings, ['peak_jerk'], run) == {'peak_jerk': None}
    course = ShiftCourse(run, start.scored_from)
    assert course.shift_time_s < 0.7
    assert course.flare < 5.0
    assert course.tie_up_work < 50.0
    least = floor_of(settings, 'peak_jerk', lock_of(run, start.step, RULES).time_s).least
    assert value_of(settings, 'peak_jerk', run, start.scored_from) < 1.5 * least


def test_a_run_with_another_handover_is_no_run_of_the_floor():
    settings = settings_of(handover='model')
    start = control_start(settings)
    run = run_headless(settings_of(handover='timed'), 'pi')
    assert case_of_run(settings, start, lock_of(run, start.step, RULES), run) is None


@pytest.mark.parametrize('further', [{'handover': 'timed'}, {'off_going_wear_gain': 0.9}])
def test_another_handover_or_wear_has_a_floor_of_its_own_in_the_cache(further):
    start, digests = control_start(settings_of()), set()
    for settings in (settings_of(), settings_of(**further)):
        case = case_at(settings, start, 0.5, limited=False)
        digests.add(digest_of(case, 'peak_jerk', True))
    assert len(digests) == 2


def test_a_changed_handover_file_has_a_floor_of_its_own_in_the_cache(tmp_path):
    file = tmp_path / 'mine.py'
    settings, digests = settings_of(handover=str(file)), set()
    start = control_start(settings_of())
    for text in ('', '\n'):
        file.write_text(text)
        case = case_at(settings, start, 0.5, limited=False)
        digests.add(digest_of(case, 'peak_jerk', True))
    assert len(digests) == 2


def test_a_floor_of_a_shift_comes_from_the_cache(monkeypatch):
    first = floor_of(settings_of(handover='slip'), 'peak_acceleration', 0.5)
    monkeypatch.setattr(computed_floor, 'bound_of', None)
    assert floor_of(settings_of(handover='slip'), 'peak_acceleration', 0.5) == first
    with pytest.raises(TypeError):
        floor_of(settings_of(handover='timed'), 'peak_acceleration', 0.5)


LATE = """
from ddct_controllers.handover.interface import Handover, HandoverCommand


class Late(Handover):
    def update(self, measurement):
        share = 1.0 if measurement.step >= {step} else 0.0
        return HandoverCommand(share, 0.0 if measurement.step >= {opens} else 150.0, 0.0)
"""


@pytest.mark.parametrize(('step', 'opens'), [(40, 60), (900, 40)])
def test_a_handover_without_an_inertia_phase_of_one_clutch_is_refused(tmp_path, step, opens):
    file = tmp_path / 'late.py'
    file.write_text(LATE.format(step=step, opens=opens))
    with refused(ParameterError, 'handover'):
        control_start(settings_of(handover=str(file)))


def test_a_gear_that_is_disengaged_is_refused():
    with refused(ParameterError, 'shift.disengagement_s'):
        control_start(settings_of(overrides=('shift.disengagement_s=1.2',)))


def test_a_lock_while_the_off_going_clutch_carries_torque_is_refused():
    settings = settings_of()
    open_s = control_start(settings).off_going.open_s
    with pytest.raises(ParameterError, match='off-going clutch may carry torque'):
        floor_of(settings, 'peak_jerk', open_s)
