# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Score bags: from a recording to its entry in `scores.json`."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ddct_bringup.bag.file.records import salvage_records
from ddct_bringup.bag.measured_run import TORSION
from ddct_bringup.bag.reader import Recording
from ddct_bringup.bag.run_facts import RunFacts
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.timing_and_failure import RunTiming, failed_run, read_timing
from ddct_bringup.scores.bags import bag_name
from ddct_bringup.scores.metrics import Metrics, compute_metrics
from ddct_bringup.scores.validity import engine_end, safe_state, why_invalid
from ddct_bringup.verdict.criteria import criterion_values, existing, finite
from ddct_bringup.verdict.judged_run import JudgedRun
from ddct_bringup.verdict.limits import Limits
from ddct_bringup.verdict.plant import JudgedPlant
from ddct_bringup.verdict.state import INVALID, slip_state
from ddct_bringup.verdict.verdict import (
    Verdict,
    judged_traction,
    verdict_of,
    verdict_of_unreadable,
)
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import steps_in
from ddct_plant.files.input_file import mcap_of
from ddct_plant.scenario.differences import changed_values

Entry = dict[str, Any]
"""One run of `scores.json`: bag, ..., metrics, verdict, fallbacks, safe_state, ..."""

SCHEMA_VERSION = 3
"""
Schema version of `scores.json`.

Version 1 had no verdict and no version number. In version 2 the verdict of a failed run had other
values, and there was no `convention` and no `traction`.
"""

NOT_COMPUTED = 'not_computed'
"""Key of `scores.json` for the log of another tool: reasons by metric or criterion."""
NEEDS: Mapping[str, tuple[str, ...]] = {
    TORSION: ('torsion_speed_std_rpm', 'judder', 'shuffle_amplitude', 'shuffle_decay'),
    'vehicle_accel': (
        'acceleration_std_m_s2',
        'peak_jerk_m_s3',
        'vdv_m_s1_75',
        'weighted_acceleration_m_s2',
        'peak_jerk',
        'mean_jerk',
        'mean_negative_jerk',
        'mean_acceleration',
        'peak_acceleration',
        'weighted_acceleration',
        'daily_vibration_dose',
    ),
    'slip_reference': ('slip_rmse_rpm',),
    'clutch_torque': ('friction_energy_j', 'friction_energy', 'friction_work_over_least'),
    'torque_request': ('torque_total_variation_n_m', 'request_variation'),
    'driveshaft_torque': ('torque_dip',),
}
"""Required quantities of a log, by metric or criterion."""

METRIC_NAMES = Metrics._fields
_COUNT = re.compile('[0-9]{1,9}')
_FACT_NAMES = (
    'controller',
    'architecture',
    'scenario',
    'clutch',
    'wear_gain',
    'mode',
    'seed',
)


def score_recording(recording: Recording, bag: str, limits: Limits) -> Entry:
    """
    Score and judge a recording, with its `timing.json` if there is one; `bag` is its name.

    The recording of a failed run has no score. Raise DdctError for timing that cannot be used.
    """
    if recording.measured:
        return score_run(recording, bag, limits, None)
    if failure := failed_run(recording.path.parent):
        return entry_without_score(bag, recording.facts, failure.reason)
    return score_run(recording, bag, limits, read_timing(recording.path.parent))


def score_run(recording: Recording, bag: str, limits: Limits, timing: RunTiming | None) -> Entry:
    """Score and judge a recording without reading files next to its bag."""
    facts = recording.facts
    computed = compute_metrics(
        recording.trajectory,
        control_start_s=facts.control_start_s,
        score_window_s=facts.score_window_s,
        timing=timing,
    )
    metrics = computed._asdict()
    reason = why_invalid(recording)
    verdict = _verdict(recording, metrics, limits, valid=not reason)
    lacking = not_computed(recording, metrics, verdict)
    settings = recording.settings
    return {
        'bag': bag,
        **{name: getattr(facts, name) for name in _FACT_NAMES},
        'valid': not reason,
        'reason': reason,
        'metrics': metrics,
        'verdict': verdict,
        'fallbacks': fallbacks_in(recording.trajectory),
        'safe_state': None if facts.lockstep else safe_state(recording),
        'before_schema': recording.before_schema,
        'scenario_changes': list(changed_values(settings.scenario)) if settings else None,
        **({NOT_COMPUTED: lacking} if recording.measured else {}),
    }


def unreadable_entry(path: Path, error: DdctError, *, relative_to: Path | None = None) -> Entry:
    """
    Return the entry of a bag that cannot be read: invalid, with the facts that are readable.

    For a failed run the entry has the reason, with or without a bag.
    """
    name = bag_name(path, relative_to)
    if failure := failed_run(path if path.is_dir() else path.parent):
        return entry_without_score(name, failure.facts, failure.reason)
    try:
        facts = RunFacts.from_custom_data(salvage_records(mcap_of(path)).custom_data)
    except DdctError:
        return entry_without_score(name, None, str(error))
    return entry_without_score(name, facts, str(error))


def entry_without_score(bag: str, facts: RunFacts | None, reason: str) -> Entry:
    """Return the entry of a failed run: invalid, with the facts that are available."""
    return {
        'bag': bag,
        **{name: getattr(facts, name, None) for name in _FACT_NAMES},
        'valid': False,
        'reason': reason,
        'metrics': dict.fromkeys(METRIC_NAMES),
        'verdict': verdict_of_unreadable(),
        'fallbacks': None,
        'safe_state': None,
        'before_schema': None,
        'scenario_changes': None,
    }


def not_computed(
    recording: Recording, metrics: Mapping[str, Any], verdict: Mapping[str, Any]
) -> dict[str, str]:
    """Return the reasons for metrics and criteria that are null for lack of a log quantity."""
    values = {each['name']: each['value'] for each in verdict['criteria']} | dict(metrics)
    return {
        name: recording.absent[quantity]
        for quantity, names in NEEDS.items()
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


def _verdict(
    recording: Recording, metrics: dict[str, Any], limits: Limits, *, valid: bool
) -> Verdict:
    facts, trajectory, rules = recording.facts, recording.trajectory, limits.rules
    plant = JudgedPlant.of(recording.settings.scenario) if recording.settings else None
    start = steps_in('control_start_s', facts.control_start_s)
    state = engine_end(recording) if valid else INVALID
    if state is None:
        state = slip_state(trajectory, start, rules, plant)
    window_s, a_day = facts.score_window_s, rules.engagements_a_day
    run = JudgedRun(trajectory, start, window_s, metrics, a_day, plant)
    return verdict_of(
        state,
        criterion_values(run),
        limits,
        facts.scenario,
        exists=existing(run),
        traction=judged_traction(finite(run.driving_acceleration), plant, limits),
    )


def scores_document(runs: Sequence[Entry], limits: Limits) -> dict[str, Any]:
    """Return the content of `scores.json` for runs that were judged by these limits."""
    return {'schema_version': SCHEMA_VERSION, 'limits': limits.origin, 'runs': list(runs)}
