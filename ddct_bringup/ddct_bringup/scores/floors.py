# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Peak jerk of a run over the least of its case: the share of the drive apart from its own."""

from collections.abc import Sequence
from dataclasses import replace

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.case import case_at, case_of_run
from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.coverage import FloorWithdrawnError, require_not_below, why_outside
from ddct_bringup.floor.dynamics.start import Start
from ddct_bringup.floor.dynamics.torque_cut import gives_demand
from ddct_bringup.floor.floor import floor_of_case
from ddct_bringup.floor.lock import Lock, final_lock_of
from ddct_bringup.metrics.catalogue import JERK_OVER_LEAST
from ddct_bringup.scores.scored_recording import ScoredRecording
from ddct_bringup.scores.scored_run import LEAST_IS_BOUND, ScoredRun
from ddct_bringup.verdict.limits import Limits
from ddct_bringup.verdict.rules import Rules
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import steps_in
from ddct_plant.program.progress import with_progress
from ddct_plant.scenario.settings import RunSettings

PEAK_JERK = 'peak_jerk'
"""Metric of `ddct limit` whose least a run is compared with."""
_MOST_PERIODS = 500
"""
Largest number of periods after control start whose least is computed with a score.

The program grows with each period: twice as many take about five times as long.
"""
_NO_INSTANT = 'the run has no final lock after the start of feedback'


def with_floors(runs: Sequence[ScoredRecording], limits: Limits) -> list[ScoredRecording]:
    """Return runs with `peak_jerk_over_least`; print the progress."""
    return [with_least(run, limits) for run in with_progress(runs, len(runs), 'floors')]


def with_least(run: ScoredRecording, limits: Limits) -> ScoredRecording:
    """Return a scored recording with `peak_jerk_over_least`; `limits` judged it."""
    if run.recording is None or run.settings is None:
        return run
    trajectory = run.recording.trajectory
    return replace(run, scores=scores_with_least(run.scores, run.settings, trajectory, limits))


def scores_with_least(
    scores: ScoredRun, settings: RunSettings, trajectory: Trajectory, limits: Limits
) -> ScoredRun:
    """Return the scores of a run with its peak jerk over the least at its final lock."""
    try:
        ratio, outside = _over_least(scores, settings, trajectory, limits.rules)
    except FloorWithdrawnError:
        raise
    except DdctError as error:
        reasons = {**scores.null_reasons, JERK_OVER_LEAST.key: str(error)}
        return replace(scores, null_reasons=reasons)
    reasons = {key: why for key, why in scores.null_reasons.items() if key != JERK_OVER_LEAST.key}
    metrics = {**scores.metrics, JERK_OVER_LEAST.key: ratio}
    if outside:
        reasons[LEAST_IS_BOUND] = outside
    return replace(scores, metrics=metrics, null_reasons=reasons, least_is_bound=not outside)


def _over_least(
    scores: ScoredRun, settings: RunSettings, trajectory: Trajectory, rules: Rules
) -> tuple[float, str]:
    """
    Return the ratio, and why its least is no bound, '' if it is one.

    Raise DdctError where the run has no ratio.
    """
    value = scores.metrics['peak_jerk_m_s3']
    if not scores.valid or value is None:
        raise DdctError(scores.reason or scores.null_reasons['peak_jerk_m_s3'])
    scenario = settings.scenario
    periods = scenario.steps - steps_in('control_start_s', scenario.control_start_s)
    if periods > _MOST_PERIODS:
        raise DdctError(
            f'the run has {periods} periods after control start, and beside a score the least is '
            f'computed for up to {_MOST_PERIODS}: use ddct limit'
        )
    start = control_start(settings)
    lock = final_lock_of(trajectory, start.step, rules)
    if lock is None:
        raise DdctError(_NO_INSTANT)
    return _beside(value, settings, trajectory, start, lock, rules)


def _beside(
    value: float,
    settings: RunSettings,
    trajectory: Trajectory,
    start: Start,
    lock: Lock,
    rules: Rules,
) -> tuple[float, str]:
    """
    Return a peak jerk over the least of the case, and why that is no bound for the run.

    The engine gives the demand, or what its limits allow where no run of the demand locks then.
    """
    for limited in (False, True):
        case = case_at(settings, start, lock.time_s, rules, limited=limited)
        least = floor_of_case(case, PEAK_JERK).least
        if least is not None:
            break
    if not least:
        raise DdctError('no run of the clutch alone locks at that instant')
    outside = why_outside(settings, start, trajectory, rules)
    if not outside and not limited and not gives_demand(trajectory, start.step):
        outside = 'meets full load or idle control'
    if not outside and value < least:
        # The run may leave the speeds of a rigid car, but not those of its own case.
        own = case_of_run(settings, start, lock, trajectory, rules)
        assert own is not None, 'the run is one of those of a floor'
        least = min(least, floor_of_case(own, PEAK_JERK).least or least)
        require_not_below(PEAK_JERK, value, least, lock)
    return value / least, outside
