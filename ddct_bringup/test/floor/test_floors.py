# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Floors contain the runs that they are compared with, and are attained by runs of the plant."""

from functools import cache
from importlib.resources import files

import numpy as np
import pytest
from made_run import made_run
from refusals import refused
from samples import sampled
from scored_metrics import SCORED
from threadpoolctl import threadpool_info, threadpool_limits

from ddct_bringup.floor import computed_floor
from ddct_bringup.floor.case import case_at, case_of_run
from ddct_bringup.floor.computed_floor import DEMAND, LIMITS, ComputedFloor
from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.coverage import FloorWithdrawnError, require_not_below, why_outside
from ddct_bringup.floor.floor import floor_of, floor_of_case, floors_of_run
from ddct_bringup.floor.friction_work import least_friction_work
from ddct_bringup.floor.front import least_lock_time
from ddct_bringup.floor.lock import Lock, final_lock_of, lock_of
from ddct_bringup.floor.metric_units import METRICS, OF_STICK_SLIP
from ddct_bringup.floor.point import point_of
from ddct_bringup.floor.program.linear_program import RAY
from ddct_bringup.floor.replays import attained, replay
from ddct_bringup.floor.values import Floor, Proof, value_of
from ddct_bringup.manifest import code
from ddct_bringup.run.execution import recording_in_memory
from ddct_bringup.run.headless import run_headless
from ddct_bringup.scores.scoring import score_run
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import PERIOD_S
from ddct_plant.scenario.file import ScenarioFile, load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

RULES = packaged_limits().rules
pytestmark = pytest.mark.slow
RUNS = (
    ('launch', 'ls8'),
    ('launch_hot', 'mpc3'),
    ('launch_gentle', 'mpc3'),
    ('thesis_sticking', 'hinf1'),
    ('thesis', 'mpc3'),
)
"""Runs that stay away from all limits, whose engine is limited, and whose capacity is clipped."""


def settings_of(scenario='launch', **further):
    return RunSettings.of(load_scenario(scenario), further)


@cache
def case_and_run(scenario, controller, *overrides):
    settings = RunSettings.of(load_scenario(scenario, overrides), {})
    run = run_headless(settings, controller)
    start = control_start(settings)
    return case_of_run(settings, start, lock_of(run, start.step, RULES), run), run


@pytest.mark.parametrize(
    ('scenario', 'controller', 'overrides'),
    [
        *((*run, ()) for run in RUNS),
        # Clipped, and the kiss point of the warm facing leaves a rest of the capacity.
        ('launch_gentle', 'mpc3', ('friction.kiss_drift_n_m_k=-0.05',)),
    ],
)
def test_a_run_is_a_point_of_the_program_that_bounds_it(scenario, controller, overrides):
    case, run = case_and_run(scenario, controller, *overrides)
    point = point_of(case, run)
    assert np.abs(case.motion.acceleration @ point - run.vehicle_accel).max() < 1e-10
    assert np.abs(case.motion.torsion_speed @ point - run.driveshaft_speed).max() < 1e-10
    rows, limits = case.inequalities.rows, case.inequalities.limits
    assert np.max(rows @ point - limits) < 1e-8
    assert np.max(np.abs(case.equations @ point), initial=0.0) < 1e-8
    assert np.all(case.motion.columns.low - point[1:] <= 1e-9)
    assert np.all(point[1:] - case.motion.columns.high <= 1e-9)


def test_the_cases_of_the_sample_differ_in_what_is_variable():
    found = {}
    for scenario, controller in RUNS[:3]:
        case, _ = case_and_run(scenario, controller)
        found[scenario] = (case.limited, bool(case.capacity.clipped))
    assert found == {
        'launch': (False, False),
        'launch_hot': (True, False),
        'launch_gentle': (False, True),
    }


@pytest.mark.parametrize(('scenario', 'controller'), sampled([RUNS[0], RUNS[4]], every=2))
def test_no_metric_of_a_run_is_below_its_floor(scenario, controller):
    """More runs, of which some are at the engine's limits, are in tests/nightly/floor."""
    settings = settings_of(scenario)
    run = run_headless(settings, controller)
    metrics = [name for name in METRICS if settings.stick_slip or name != OF_STICK_SLIP]
    for metric, over in floors_of_run(settings, metrics, run).items():
        assert over.value >= over.floor.least, metric


@pytest.mark.usefixtures('own_cache')
def test_no_run_near_a_least_of_zero_is_searched_for(monkeypatch):
    monkeypatch.setattr(computed_floor, 'replays_of', None)
    floor = floor_of(settings_of(), OF_STICK_SLIP, 1.0)
    assert (floor.least, floor.attained, floor.gap) == (0.0, None, None)


def test_the_values_are_those_of_scores():
    settings = settings_of()
    run = run_headless(settings, 'ls8')
    entry = score_run(recording_in_memory(settings, 'ls8', run), 'ls8', packaged_limits(), None)
    start = settings.scenario.control_start_step
    for metric, key in SCORED.items():
        value = value_of(settings, metric, run, start)
        assert value == pytest.approx(entry.metrics[key], rel=1e-12), metric


@pytest.mark.parametrize(
    ('scenario', 'time_s', 'gap'),
    sampled(
        [
            ('launch', 0.8, 2.0),
            ('launch', 0.5, 25.0),
            ('thesis_sticking', 0.8, 5.0),
            ('thesis', 0.5, 2.0),
            ('thesis', 0.48, 2.0),
        ],
        every=3,
    ),
)
def test_the_least_peak_jerk_is_nearly_attained_by_a_run_that_locks_then(scenario, time_s, gap):
    """Where the engine is limited the intervals are wide, so the gap is wider."""
    floor = floor_of(settings_of(scenario), 'peak_jerk', time_s)
    assert floor.attained >= floor.least
    assert 0.0 <= floor.gap <= gap
    assert floor.replay_residual <= 0.03 * floor.attained
    assert floor.certificate.covers == (LIMITS if gap == 25.0 else DEMAND)


@pytest.mark.parametrize('wear_gain', sampled([0.7, 1.3], every=2))
def test_a_worn_clutch_has_the_same_floor_as_its_requests_are_free(wear_gain):
    """The start differs, as C_fOL is always on, so a floor moves a little."""
    floor = floor_of(settings_of(wear_gain=wear_gain), 'peak_jerk', 1.1)
    assert floor.attained >= floor.least > 0.0
    assert floor.gap < 5.0


@pytest.mark.usefixtures('own_cache')
def test_after_a_replay_that_does_not_lock_as_the_floor_has_it_another_one_does(monkeypatch):
    """Its slip closes faster at last."""
    lock, locks = attained._locks, []

    def noted(case, run):
        locks.append(lock(case, run))
        return locks[-1]

    monkeypatch.setattr(attained, '_locks', noted)
    floor = floor_of(settings_of(), 'weighted_acceleration', 0.6)
    assert locks[:2] == [False, True]
    assert floor.attained >= floor.least


@pytest.mark.usefixtures('own_cache')
def test_after_two_replays_that_do_not_lock_as_the_floor_has_it_there_is_no_third(monkeypatch):
    replays = []

    def replayed(case, requests):
        replays.append(requests)
        return replay.replayed(case, requests)

    monkeypatch.setattr(attained, 'replayed', replayed)
    monkeypatch.setattr(attained, '_locks', lambda case, run: False)
    floor = floor_of(settings_of(), 'peak_jerk', 0.9)
    assert floor.least > 0.0 and floor.attained is None
    assert len(replays) == 2
    assert not np.array_equal(*replays)


def test_the_usual_requests_take_the_slip_of_a_rigid_car_with_drag_linearly_to_zero():
    """Its speeds are in the middle of the band of the case."""
    changes = {
        'driveline.engine_damping': 0.05,
        'driveline.shaft_damping': 0.02,
        'equilibrium': 'full',
    }
    settings = RunSettings.of(load_scenario('launch', changes), {})
    case = case_at(settings, control_start(settings), 0.8)
    requests, p = replay.usual_requests(case), settings.scenario.controlled_driveline
    engine = (case.tube.engine_low + case.tube.engine_high) / 2.0
    wheel = (case.tube.wheel_low + case.tube.wheel_high) / 2.0
    drag = p.shaft_damping * p.gear.shaft_speed(wheel)
    load = p.gear.shaft_torque(case.load.offset + case.load.slope * wheel + case.load.middle)
    given = case.engine.offset + case.engine.slope * engine + case.engine.middle
    rest = p.shaft_inertia + p.gear.at_shaft(p.vehicle_inertia)
    of_engine = (given - p.engine_damping * engine - requests) / p.engine_inertia
    closing = of_engine - (requests - drag - load) / rest
    np.testing.assert_allclose(closing[:80], -case.start.slip / 0.8, rtol=1e-12)


def test_only_a_linear_clutch_that_was_outside_its_band_locks_when_it_settles():
    slip_rpm = np.zeros(200)
    assert final_lock_of(made_run(slip_rpm), 0, RULES) is None
    slip_rpm[0] = 300.0
    assert final_lock_of(made_run(slip_rpm), 0, RULES) == Lock(PERIOD_S)


def test_a_floor_is_computed_once_and_then_read_from_the_cache(monkeypatch):
    first = floor_of(settings_of(), 'peak_acceleration', 0.9)
    monkeypatch.setattr(computed_floor, 'bound_of', None)
    assert floor_of(settings_of(), 'peak_acceleration', 0.9) == first
    with pytest.raises(TypeError):
        floor_of(settings_of(wear_gain=0.99), 'peak_acceleration', 0.9)


def test_a_floor_is_computed_anew_after_a_change_of_any_package(monkeypatch):
    """Its replays run the plant, and its metrics have filters of other rooms."""
    floor_of(settings_of(), 'peak_acceleration', 0.9)
    monkeypatch.setattr(code, 'files', changed_plant)
    code.code_digest.cache_clear()
    try:
        monkeypatch.setattr(computed_floor, 'bound_of', None)
        with pytest.raises(TypeError):
            floor_of(settings_of(), 'peak_acceleration', 0.9)
    finally:
        code.code_digest.cache_clear()


def changed_plant(package):
    """Return the files of a package; those of ddct_plant are other ones."""
    return files('ddct_reference' if package == 'ddct_plant' else package)


@pytest.mark.parametrize(
    ('of_demand', 'of_limits', 'least'),
    [(2.0, 3.0, 2.0), (3.0, 2.0, 2.0), (2.0, None, 2.0), (None, 3.0, 3.0)],
)
def test_the_attained_value_is_the_less_of_runs_with_the_demand_and_with_limits(
    monkeypatch, of_demand, of_limits, least
):
    def found(case, metric, begin):
        value = of_limits if case.limited else of_demand
        floor = Floor(metric, 0.9, 1.0, value, Proof(RAY, 1.0, ''), None)
        return ComputedFloor(floor, limited=not case.limited)

    monkeypatch.setattr('ddct_bringup.floor.floor.computed_floor', found)
    assert floor_of(settings_of(), 'peak_jerk', 0.9).attained == least


@pytest.mark.usefixtures('own_cache')
@pytest.mark.parametrize(('named', 'expected'), [(None, 1), ('2', 2)])
def test_a_floor_is_computed_by_one_thread_unless_the_user_wants_more(
    monkeypatch, named, expected
):
    """As where numpy was loaded first, with other numbers of threads."""
    during = []

    def bound_of(*_):
        during.extend(thread_numbers())

    monkeypatch.setattr(computed_floor, 'bound_of', bound_of)
    if named:
        monkeypatch.setenv('OPENBLAS_NUM_THREADS', named)
    else:
        monkeypatch.delenv('OPENBLAS_NUM_THREADS', raising=False)
    case, _ = case_and_run(*RUNS[0])
    for compute in (
        lambda: floor_of(settings_of(), 'peak_jerk', 0.9),
        lambda: floor_of_case(case, 'peak_jerk'),
    ):
        during.clear()
        with threadpool_limits(3 - expected, user_api='blas'):
            with pytest.raises(ParameterError, match='is not defined'):
                compute()
            assert {*thread_numbers()} == {3 - expected}
        assert {*during} == {expected}


def thread_numbers():
    return [each['num_threads'] for each in threadpool_info() if each['user_api'] == 'blas']


def test_a_lock_at_once_is_impossible_and_has_its_ray():
    floor = floor_of(settings_of(), 'peak_jerk', 0.05)
    assert (floor.least, floor.attained, floor.gap) == (None, None, None)
    assert floor.certificate.kind == RAY
    assert floor.certificate.proven > 0.0


@pytest.mark.parametrize('metric', sampled(['peak_jerk', 'acceleration_std_m_s2'], every=2))
def test_a_lock_before_any_request_acts_leaves_nothing_to_choose(metric):
    floor = floor_of(settings_of(), metric, 0.005)
    assert (floor.least, floor.attained) == (None, None)
    assert floor.certificate.kind == RAY


def test_a_run_whose_engine_meets_its_cut_is_outside_and_any_other_above_its_floor():
    """In a shift the engine is fastest before the lock: 326 rad/s, a locked car has 284."""
    limits = {'engine_limits.cut_rad_s': 320.0, 'engine_limits.resume_rad_s': 310.0}
    for changes, outside in [({}, ''), (limits, 'meets the cut of the engine')]:
        settings = RunSettings.of(load_scenario('upshift', changes), {})
        run = run_headless(settings, 'ls8')
        start = control_start(settings)
        assert why_outside(settings, start, run, RULES) == outside
        over = floors_of_run(settings, ['peak_jerk'], run)['peak_jerk']
        assert (over is None) == bool(outside)


def test_a_covered_run_below_its_floor_withdraws_the_floor():
    require_not_below('peak_jerk', 5.0, 5.0 + 1e-9, Lock(1.0))
    with pytest.raises(FloorWithdrawnError, match='peak_jerk .* is 4, below its proven floor 5:'):
        require_not_below('peak_jerk', 4.0, 5.0, Lock(1.0))


def test_a_run_that_slips_again_has_no_floor():
    settings = settings_of()
    run = run_headless(settings, 'hinf2')
    assert floors_of_run(settings, ['peak_jerk'], run) == {'peak_jerk': None}


@pytest.mark.parametrize(
    ('settings', 'words'),
    [
        (settings_of('tip_in'), 'do not slip at control start'),
        (settings_of('launch_hill'), 'wheels do not turn'),
        (settings_of('thesis', architecture='base'), 'choose the architecture detailed'),
    ],
)
def test_a_case_without_floors_is_refused(settings, words):
    with pytest.raises(ParameterError, match=words):
        floor_of(settings, 'peak_jerk', 0.5)


def test_friction_that_depends_on_the_slip_speed_is_refused():
    changes = {'friction.slip_rad_s': [0.0, 100.0], 'friction.slip_share': [1.0, 0.9]}
    scenario = ScenarioFile.read('launch').scenario(changes)
    with refused(ParameterError, 'friction.slip_rad_s'):
        floor_of(RunSettings(KnownSettings(scenario)), 'peak_jerk', 0.8)


def test_the_least_friction_work_is_the_energy_of_the_slip_and_a_little_more():
    settings = settings_of()
    start = control_start(settings)
    case = case_at(settings, start, 1.0)
    p = settings.scenario.driveline
    rest = p.shaft_inertia + p.gear.at_shaft(p.vehicle_inertia)
    joint = p.engine_inertia * rest / (p.engine_inertia + rest)
    energy = joint * start.slip**2 / 2.0
    assert energy < least_friction_work(case) < 1.2 * energy


def test_the_least_lock_time_under_a_cap_is_attained_and_earlier_ones_are_excluded():
    settings = settings_of()
    start = control_start(settings)
    times = (0.7, 0.8, 0.9, 1.0)
    floors = [floor_of(settings, 'peak_jerk', time, start) for time in times]
    found = least_lock_time(floors, 'peak_jerk', 6.9)
    assert found.lock_time_s == found.excluded_before_s == 0.9
    assert least_lock_time(floors, 'peak_jerk', 1.0).lock_time_s is None
    proven, attained = floors[2].least, floors[2].attained
    assert least_lock_time(floors, 'peak_jerk', proven).excluded_before_s == 0.9
    assert least_lock_time(floors, 'peak_jerk', attained).lock_time_s == 0.9
