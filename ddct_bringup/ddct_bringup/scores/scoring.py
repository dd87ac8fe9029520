# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Score recordings: metrics, validity, state and limits of each run."""

import re
from collections.abc import Mapping
from pathlib import Path

from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.run_facts import RunFacts, described_run
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.catalogue import JERK_OVER_LEAST, METRICS, NEEDED_BY
from ddct_bringup.metrics.engagement import Engagement
from ddct_bringup.metrics.metric import Metrics
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.metrics.values import metrics_of, null_reasons, window_steps
from ddct_bringup.run.timing_and_failure import RunTiming, failed_run
from ddct_bringup.scores.bags import bag_name
from ddct_bringup.scores.engine_cut import engine_cut
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.validity import engine_end, incomplete, safe_state, why_invalid
from ddct_bringup.verdict.limits import Limits
from ddct_bringup.verdict.state import INVALID, State, state_of
from ddct_plant.bag_file.records import readable_custom_data
from ddct_plant.base.errors import DdctError, without_folders
from ddct_plant.base.timebase import steps_in
from ddct_plant.files.input_file import mcap_of
from ddct_plant.scenario.differences import changed_values

NOT_COMPUTED = 'the least was not computed'
_NO_PHASES = 'a log has no phases of the plates'
_OF_NO_LOG = {
    'time_to_final_lock_s': _NO_PHASES,
    'releases': _NO_PHASES,
    'peak_temperature_degc': 'a log has no temperature of the facing',
    'friction_work_over_least': 'a log has no inertias of the car',
    JERK_OVER_LEAST.key: 'a log has no scenario, and no floor',
    **{each.key: 'a log has no update times' for each in METRICS.values() if each.from_timing},
}
"""Reasons why no log of a car has a value, by metric."""
_COUNT = re.compile('[0-9]{1,9}')


def score_run(
    recording: Recording, bag: str, limits: Limits, timing: RunTiming | None
) -> ScoredRun:
    """
    Score and judge a recording without reading files next to its bag.

    That of an unfinished bag has no score.
    """
    facts = recording.facts
    if recording.unfinished:
        reason = f'{incomplete(recording)}: if its recorder still runs, stop it first'
        return run_without_score(bag, facts, reason)
    reason = why_invalid(recording)
    engagement = engagement_of(recording, timing)
    metrics = metrics_of(engagement)
    state = State(INVALID)
    if not reason:
        state = state_of(engagement, engine_end(recording), limits.rules)
    settings = recording.settings
    return ScoredRun(
        bag=bag,
        facts=facts,
        valid=not reason,
        reason=reason,
        metrics=metrics,
        state=state.name,
        why=state.why,
        limits=limits.beside(metrics, facts.scenario, engagement.plant),
        fallbacks=fallbacks_in(recording.trajectory),
        safe_state=None if facts.lockstep else safe_state(recording),
        scenario_changes=tuple(changed_values(settings.scenario)) if settings else None,
        gain_changes=recording.gain_changes,
        engine_cut=engine_cut(settings, recording.trajectory) if settings else None,
        null_reasons={
            **null_reasons(engagement, metrics),
            JERK_OVER_LEAST.key: NOT_COMPUTED,
            **_absent_in_log(recording, metrics),
        },
    )


def unreadable_run(path: Path, error: DdctError, *, relative_to: Path | None = None) -> ScoredRun:
    """
    Return the run of a bag that cannot be read: invalid, with the facts that are readable.

    A failed run has its reason, with or without a bag.
    """
    name = bag_name(path, relative_to)
    if failure := failed_run(path if path.is_dir() else path.parent):
        return run_without_score(name, failure.facts, failure.reason)
    try:
        _, facts = described_run(readable_custom_data(mcap_of(path)))
    except DdctError:
        return run_without_score(name, None, str(error))
    return run_without_score(name, facts, str(error))


def run_without_score(bag: str, facts: RunFacts | None, reason: str) -> ScoredRun:
    """Return a failed run: invalid, with the facts that are available."""
    metrics = dict.fromkeys(METRICS)
    nulls = dict.fromkeys(METRICS, 'the run has no scores')
    reason = without_folders(reason)
    return ScoredRun(bag, facts, False, reason, metrics, INVALID, null_reasons=nulls)


def _absent_in_log(recording: Recording, metrics: Metrics) -> Mapping[str, str]:
    """Return the reasons for metrics that a log does not have; none for a simulated run."""
    if not recording.measured:
        return {}
    lacking = {
        name: recording.absent[quantity]
        for quantity, names in NEEDED_BY.items()
        for name in names
        if quantity in recording.absent and metrics[name] is None
    }
    return {**_OF_NO_LOG, **lacking}


def fallbacks_in(trajectory: Trajectory) -> int | None:
    """
    Return the number of steps at which the controller reported no solution of its program.

    None for a controller whose status does not count them. While feedback is off none does.
    """
    for status in reversed(trajectory.status):
        count = dict(status).get('fallbacks')
        if count is not None:
            return int(count) if _COUNT.fullmatch(count) else None
    return None


def engagement_of(recording: Recording, timing: RunTiming | None) -> Engagement:
    """Return the signals and conditions from which metrics and the state are computed."""
    facts, settings = recording.facts, recording.settings
    return Engagement(
        recording.trajectory,
        steps_in('control_start_s', facts.control_start_s),
        window_steps(facts.score_window_s),
        facts.steps,
        JudgedPlant.of(settings.scenario) if settings else None,
        timing,
    )
