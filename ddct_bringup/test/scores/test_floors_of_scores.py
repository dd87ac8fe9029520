# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Floors beside scores: what no controller can keep, and how far a run is above the least."""

import io
from dataclasses import replace
from typing import Any

import pytest
from made_scores import made_result, made_scores, made_verdict
from refusals import refused

from ddct_bringup.floor.any_lock import least_at_any_lock, lock_times
from ddct_bringup.floor.computed_floor import DEMAND, LIMITS
from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.values import METRICS
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.csv_text import score_row
from ddct_bringup.scores.floors import ALL, NONE, USUAL, floor_metrics, with_floors
from ddct_bringup.scores.run_table import COLUMNS, CONTROLLER, print_runs
from ddct_bringup.scores.scored_recording import ScoredRecording, simulate_and_score
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.limits import Limit, Limits, packaged_limits
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

pytestmark = pytest.mark.slow


def settings_of(scenario: str = 'thesis', clutch: str = 'linear', **further: Any) -> RunSettings:
    """Return settings of a packaged scenario."""
    return RunSettings(load_scenario(scenario), clutch=clutch, **further)


def scored(
    controller: str, settings: RunSettings, floors: str = USUAL, limits: Limits | None = None
) -> ScoredRun:
    """Return the scores of a headless run with its floors."""
    limits = limits or packaged_limits()
    run = simulate_and_score(RunPlan(settings, controller, 'headless'), limits)
    return with_floors(run, floor_metrics(floors), limits).scores


def limited(criterion: str, value: float, unit: str) -> Limits:
    """Return the packaged rules with this limit alone."""
    limit = Limit(criterion, value, unit, None, 'A, 1', convention=False)
    return replace(packaged_limits(), limits=(limit,), traction=None)


def states(run: ScoredRun) -> dict[str, str]:
    """Return the state of each criterion with a limit."""
    return {each.name: each.state for each in run.verdict.results if each.limit is not None}


def test_what_the_drive_exceeds_is_unavoidable_and_what_a_controller_adds_is_beyond() -> None:
    pi, mpc3 = (scored(name, settings_of()) for name in ('pi', 'mpc3'))
    assert (pi.verdict.limits, mpc3.verdict.limits) == ('unavoidable', 'beyond')
    for run in (pi, mpc3):
        assert states(run)['weighted_acceleration'] == states(run)['traction'] == 'unavoidable'
    assert states(pi)['daily_vibration_dose'] == 'within'
    assert states(mpc3)['daily_vibration_dose'] == 'beyond'
    floors = {each.name: each for each in pi.verdict.results}
    lowest = floors['weighted_acceleration']
    assert lowest.least_at_any_lock is not None
    assert lowest.limit is not None
    assert lowest.least is not None
    assert lowest.limit < lowest.least_at_any_lock <= lowest.least


def test_the_same_run_is_beyond_a_limit_between_the_least_and_its_value() -> None:
    for limit, state in ((0.3, 'unavoidable'), (0.5, 'beyond'), (2.0, 'within')):
        limits = limited('weighted_acceleration', limit, 'm/s^2')
        run = scored('pi', settings_of(), limits=limits)
        assert (states(run), run.verdict.limits) == ({'weighted_acceleration': state}, state)


def test_no_metric_is_below_the_least_at_the_same_lock_time() -> None:
    """Other scenarios are in tests/nightly/floor."""
    run = scored('ls8', settings_of(), ALL)
    assert set(run.over_floor) == set(METRICS) - {'slip_acceleration_at_lock'}
    assert run.no_floor == ''
    ratios = [ratio for ratio in run.over_floor.values() if ratio is not None]
    assert len(ratios) >= 7
    assert min(ratios) >= 1.0
    for each in run.verdict.results:
        if each.over_floor is not None and each.name != 'friction_energy':
            assert each.value is not None
            assert each.least is not None
            assert each.over_floor == pytest.approx(abs(each.value) / each.least, rel=1e-9)


@pytest.mark.parametrize(
    ('controller', 'settings', 'reason'),
    [
        ('hinf2', settings_of('launch', 'stick_slip'), 'lock once'),
        ('mpc4', settings_of(), 'commands the engine'),
        ('ls8', settings_of('launch_hill', 'stick_slip'), 'wheels do not turn'),
        ('pi', settings_of(architecture='feedforward'), 'choose the architecture detailed'),
    ],
)
def test_a_run_outside_of_all_floors_has_none_and_the_reason_in_one_line(
    controller: str, settings: RunSettings, reason: str
) -> None:
    run = scored(controller, settings)
    assert set(run.over_floor) >= {'peak_jerk', 'peak_acceleration'}
    assert set(run.over_floor.values()) == {None}
    assert reason in run.no_floor
    assert '\n' not in run.no_floor
    assert 'unavoidable' not in states(run).values()


def test_a_long_run_has_no_floor_beside_its_score_and_the_reason() -> None:
    long = RunSettings(load_scenario('thesis', {'duration_s': 6.0}))
    run = scored('pi', long)
    assert set(run.over_floor.values()) == {None}
    assert run.no_floor.startswith('540 periods after control start')
    assert run.no_floor.endswith('use ddct limit')


def test_without_floors_nothing_is_computed_or_printed() -> None:
    run = scored('pi', settings_of(), NONE)
    assert (run.over_floor, run.no_floor, run.verdict.limits) == ({}, '', 'beyond')


def test_where_the_engine_has_limits_a_floor_for_all_covers_runs_in_which_they_act() -> None:
    for settings, covers in (
        (settings_of(), DEMAND),
        (settings_of('launch', 'stick_slip'), LIMITS),
    ):
        floor = least_at_any_lock(settings, 'peak_acceleration', control_start(settings), 1e-3)
        assert floor is not None
        assert floor.certificate['covers'] == covers


def test_one_lock_time_is_enough_for_a_linear_clutch_as_its_floors_fall_with_the_time() -> None:
    settings = settings_of()
    start = control_start(settings)
    assert lock_times(settings, start) == [2.1]
    assert lock_times(settings_of(clutch='stick_slip'), start)[0] == 2.1
    assert len(lock_times(settings_of(clutch='stick_slip'), start)) == 6


def test_the_dose_of_other_engagements_a_day_has_no_floor() -> None:
    packaged = packaged_limits()
    limits = replace(packaged, rules=replace(packaged.rules, engagements_a_day=2000.0))
    run = scored('pi', settings_of(), limits=limits)
    assert 'daily_vibration_dose' not in run.over_floor
    assert states(run)['daily_vibration_dose'] == 'beyond'


def printed(*runs: ScoredRun) -> str:
    """Return the table of runs."""
    stream = io.StringIO()
    print_runs(runs, (CONTROLLER, *COLUMNS), stream)
    return stream.getvalue()


def test_the_table_has_the_ratio_and_names_the_limits_that_no_controller_can_keep() -> None:
    unavoidable = made_result(
        'weighted_acceleration',
        0.97,
        0.315,
        unit='m/s^2',
        state='unavoidable',
        least=0.8,
        least_at_any_lock=0.364,
    )
    beyond = made_result('daily_vibration_dose', 9.4, 9.1, state='beyond', least=7.823)
    run = made_scores(
        'pi',
        verdict=made_verdict('engaged', 'beyond', unavoidable, beyond),
        over_floor={'peak_jerk': 2.5},
        peak_jerk_m_s3=5.0,
    )
    other = made_scores('mpc4', no_floor='it commands the engine', over_floor={'peak_jerk': None})
    text = printed(run, other)
    assert '/least' in text
    assert '2.50' in text
    assert 'daily_vibration_dose 9.1 1 (A, 1): pi 9.4 (at its lock time at least 7.82)' in text
    assert 'no controller of the clutch can have less than 0.364: pi 0.97' in text
    assert 'no floor, as it commands the engine: mpc4' in text
    assert '/least' not in printed(made_scores('pi', peak_jerk_m_s3=5.0))


def test_csv_has_a_column_of_each_ratio() -> None:
    row = score_row(made_scores('pi', over_floor={'peak_jerk': 2.5}))
    assert row['over_floor.peak_jerk'] == 2.5
    assert [key for key in row if key.startswith('over_floor.')] == [
        f'over_floor.{name}' for name in METRICS
    ]
    assert row['over_floor.mean_jerk'] is None


@pytest.mark.parametrize(
    ('text', 'key'), [('jerk', 'jerk'), ('', '--floors'), ('peak_jerk,none', 'none')]
)
def test_an_unknown_metric_is_refused(text: str, key: str) -> None:
    with refused(ParameterError, key):
        floor_metrics(text)


def test_a_log_or_an_unreadable_bag_keeps_its_scores() -> None:
    run = ScoredRecording(made_scores('pi'))
    assert with_floors(run, ('peak_jerk',), packaged_limits()) is run
