# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Score recordings: metrics, validity and verdict of each run."""

import re
from collections.abc import Mapping
from pathlib import Path

from ddct_bringup.bag.recording import Recording
from ddct_bringup.bag.run_facts import RunFacts
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.metrics.catalogue import METRICS, NEEDED_BY
from ddct_bringup.metrics.engagement import Engagement
from ddct_bringup.metrics.metric import Metrics, finite
from ddct_bringup.metrics.plant import JudgedPlant
from ddct_bringup.metrics.values import criteria_of, existing, metrics_of, window_steps
from ddct_bringup.run.timing_and_failure import RunTiming, failed_run
from ddct_bringup.scores.bags import bag_name
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.scores.validity import engine_end, safe_state, why_invalid
from ddct_bringup.verdict.limits import Limits
from ddct_bringup.verdict.shift_state import state_of_shift
from ddct_bringup.verdict.state import INVALID, slip_state
from ddct_bringup.verdict.verdict import UNREADABLE, Verdict, judged_traction, verdict_of
from ddct_plant.bag_file.records import salvage_records
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import steps_in
from ddct_plant.files.input_file import mcap_of
from ddct_plant.scenario.differences import changed_values

_COUNT = re.compile('[0-9]{1,9}')


def score_run(
    recording: Recording, bag: str, limits: Limits, timing: RunTiming | None
) -> ScoredRun:
    """Score and judge a recording without reading files next to its bag."""
    facts = recording.facts
    reason = why_invalid(recording)
    engagement = engagement_of(recording, limits, timing)
    metrics = metrics_of(engagement)
    verdict = _verdict(recording, engagement, metrics, limits, valid=not reason)
    settings = recording.settings
    return ScoredRun(
        bag=bag,
        facts=facts,
        valid=not reason,
        reason=reason,
        metrics=metrics,
        verdict=verdict,
        fallbacks=fallbacks_in(recording.trajectory),
        safe_state=None if facts.lockstep else safe_state(recording),
        before_schema=recording.before_schema,
        scenario_changes=tuple(changed_values(settings.scenario)) if settings else None,
        gain_changes=recording.gain_changes,
        not_computed=not_computed(recording, metrics, verdict),
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
        facts = RunFacts.from_custom_data(salvage_records(mcap_of(path)).custom_data)
    except DdctError:
        return run_without_score(name, None, str(error))
    return run_without_score(name, facts, str(error))


def run_without_score(bag: str, facts: RunFacts | None, reason: str) -> ScoredRun:
    """Return a failed run: invalid, with the facts that are available."""
    metrics = dict.fromkeys(METRICS)
    return ScoredRun(bag, facts, False, reason, metrics, UNREADABLE)


def not_computed(recording: Recording, metrics: Metrics, verdict: Verdict) -> Mapping[str, str]:
    """Return the reasons for metrics and criteria that are None for lack of a log quantity."""
    values = {**verdict.values, **metrics}
    return {
        name: recording.absent[quantity]
        for quantity, names in NEEDED_BY.items()
        for name in names
        if quantity in recording.absent and values.get(name) is None
    }


def fallbacks_in(trajectory: Trajectory) -> int | None:
    """
    Return the number of steps at which the controller reported no solution of its program.

    None for a controller whose status does not count them.
    """
    count = dict(trajectory.status[-1]).get('fallbacks', '')
    return int(count) if _COUNT.fullmatch(count) else None


def engagement_of(recording: Recording, limits: Limits, timing: RunTiming | None) -> Engagement:
    """Return the signals and conditions from which metrics and criteria are computed."""
    facts, settings = recording.facts, recording.settings
    return Engagement(
        recording.trajectory,
        steps_in('control_start_s', facts.control_start_s),
        window_steps(facts.score_window_s),
        limits.rules.engagements_a_day,
        JudgedPlant.of(settings.scenario) if settings else None,
        timing,
    )


def _verdict(
    recording: Recording, engagement: Engagement, metrics: Metrics, limits: Limits, *, valid: bool
) -> Verdict:
    plant = engagement.plant
    state = engine_end(recording) if valid else INVALID
    if state is None:
        state = slip_state(recording.trajectory, engagement.judged_from, limits.rules, plant)
    state = state_of_shift(state, engagement.shift, limits.shift)
    return verdict_of(
        state,
        criteria_of(engagement, metrics),
        limits,
        recording.facts.scenario,
        exists=existing(engagement),
        traction=judged_traction(finite(engagement.driving_acceleration), plant, limits),
    )
