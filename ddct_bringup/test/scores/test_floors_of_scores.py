# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The peak jerk of a run over the least of its case, and whether that least is a bound for it."""

from dataclasses import replace
from typing import Any

import pytest
from made_scores import made_scores
from samples import sampled

from ddct_bringup.floor.case import case_at
from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.floor import floor_of, floor_of_case
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.csv_text import score_row
from ddct_bringup.scores.engine_cut import cut_note
from ddct_bringup.scores.floors import with_least
from ddct_bringup.scores.scored_recording import ScoredRecording, simulate_and_score
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.limits import Limits, packaged_limits
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

pytestmark = pytest.mark.slow


def settings_of(scenario: str = 'thesis', **further: Any) -> RunSettings:
    """Return settings of a packaged scenario."""
    return RunSettings.of(load_scenario(scenario), further)


CUT = {'engine_limits.cut_rad_s': 440.0, 'engine_limits.resume_rad_s': 390.0}


def scored(controller: str, settings: RunSettings, limits: Limits | None = None) -> ScoredRun:
    """Return the scores of a headless run beside the least of its case."""
    limits = limits or packaged_limits()
    run = simulate_and_score(RunPlan(settings, controller, 'headless'), limits)
    return with_least(run, limits).scores


@pytest.mark.parametrize('scenario', ['launch', 'upshift'])
def test_the_ratio_is_that_to_the_least_at_the_final_lock(scenario: str) -> None:
    settings = settings_of(scenario)
    run = scored('ls8', settings)
    start = control_start(settings)
    lock_s = run.metrics['time_to_final_lock_s']
    assert lock_s is not None
    from_feedback = lock_s - 0.01 * (start.step - settings.scenario.control_start_step)
    least = floor_of_case(
        case_at(settings, start, from_feedback, limited=False), 'peak_jerk'
    ).least
    assert least is not None
    peak = run.metrics['peak_jerk_m_s3']
    assert peak is not None
    assert run.metrics['peak_jerk_over_least'] == pytest.approx(peak / least, rel=1e-12)
    assert run.metrics['peak_jerk_over_least'] > 1.0
    assert run.least_is_bound is True
    assert 'peak_jerk_over_least' not in run.null_reasons


def test_a_linear_clutch_locks_where_its_slip_stays_within_the_band_of_the_rules() -> None:
    packaged = packaged_limits()
    narrow = replace(packaged, rules=replace(packaged.rules, engaged_slip=40.0))
    wide, strict = (scored('ls8', settings_of(), limits) for limits in (packaged, narrow))
    for run in (wide, strict):
        assert (run.state, run.least_is_bound) == ('engaged', True)
    assert wide.metrics['peak_jerk_m_s3'] == strict.metrics['peak_jerk_m_s3']
    # It comes into the narrower band later, and has to be within it from then on.
    ratios = wide.metrics['peak_jerk_over_least'], strict.metrics['peak_jerk_over_least']
    assert None not in ratios
    assert ratios[0] != ratios[1]


@pytest.mark.parametrize(
    ('controller', 'settings', 'reason'),
    sampled(
        [
            ('pi', settings_of('launch'), 'slips again'),
            ('torque_estimator', settings_of('launch'), 'commands the engine'),
            ('mpc4', settings_of(), 'commands the engine'),
        ],
        every=2,
    ),
)
def test_for_a_run_that_does_more_than_lock_once_the_least_is_a_yardstick(
    controller: str, settings: RunSettings, reason: str
) -> None:
    run = scored(controller, settings)
    assert run.metrics['peak_jerk_over_least'] is not None
    assert (run.least_is_bound, run.outside) == (False, reason)


def test_a_note_names_the_runs_whose_peak_jerk_is_of_the_fuel_cut() -> None:
    run = scored('ls8', RunSettings(KnownSettings(load_scenario('launch', CUT))))
    assert run.engine_cut
    earlier = replace(run.engine_cut, step=290, peak_jerk_step=120)
    assert cut_note({'ls8': run.engine_cut, 'pi': earlier}) == (
        'the engine reaches its cut, 440 rad/s, at 2.90 s in ls8, pi; the cut makes the peak jerk '
        f'of ls8 ({run.engine_cut.peak_jerk_step / 100:.2f} s): shorten the drive: '
        '--set duration_s=2.8'
    )
    assert cut_note({}) == ''


@pytest.mark.parametrize(
    ('controller', 'settings', 'reason'),
    [
        ('mpc3', settings_of('thesis_sticking'), 'no final lock'),
        ('ls8', settings_of('launch_hill'), 'wheels do not turn'),
        ('pi', settings_of(architecture='feedforward'), 'choose the architecture detailed'),
        ('ls8', settings_of('tip_in'), 'nothing to engage'),
        ('ls8', RunSettings(KnownSettings(load_scenario('launch', CUT))), 'reaches its cut'),
        (
            'pi',
            RunSettings(KnownSettings(load_scenario('thesis', {'duration_s': 6.0}))),
            '540 periods after control start',
        ),
    ],
)
def test_a_case_without_a_floor_has_no_ratio_and_the_reason_in_one_line(
    controller: str, settings: RunSettings, reason: str
) -> None:
    run = scored(controller, settings)
    assert (run.metrics['peak_jerk_over_least'], run.least_is_bound) == (None, None)
    assert reason in run.null_reasons['peak_jerk_over_least']
    assert '\n' not in run.null_reasons['peak_jerk_over_least']


def test_the_ratio_depends_on_the_final_lock_and_not_on_what_else_the_run_did() -> None:
    settings = settings_of('launch')
    start, run = control_start(settings), scored('pi', settings)
    assert run.metrics['releases'] == 1
    lock_s, peak = (run.metrics[name] for name in ('time_to_final_lock_s', 'peak_jerk_m_s3'))
    assert lock_s is not None and peak is not None
    least = floor_of(settings, 'peak_jerk', lock_s, start).least
    assert least is not None
    assert run.metrics['peak_jerk_over_least'] == pytest.approx(peak / least, rel=1e-12)


def test_without_floors_nothing_is_computed() -> None:
    plan = RunPlan(settings_of('launch'), 'ls8', 'headless')
    run = simulate_and_score(plan, packaged_limits())
    assert run.scores.metrics['peak_jerk_over_least'] is None
    assert run.scores.null_reasons['peak_jerk_over_least'] == 'the least was not computed'


def test_csv_has_a_column_of_the_ratio_and_of_its_meaning() -> None:
    row = score_row(made_scores('pi', peak_jerk_over_least=2.5, least_is_bound=False))
    assert (row['peak_jerk_over_least'], row['least_is_bound']) == (2.5, False)


def test_a_log_or_an_unreadable_bag_keeps_its_scores() -> None:
    run = ScoredRecording(made_scores('pi'))
    assert with_least(run, packaged_limits()) is run
