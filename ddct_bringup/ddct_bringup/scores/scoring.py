"""Score bags: from a recording to its entry in `scores.json`."""

import dataclasses
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ddct_bringup.bag.end_cause import recorded_end_cause
from ddct_bringup.bag.file.records import mcap_of, salvage_records
from ddct_bringup.bag.reader import Recording
from ddct_bringup.bag.run_facts import RunFacts
from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.run.run_timing import read_timing
from ddct_bringup.scores.bags import bag_name
from ddct_bringup.scores.metrics import Metrics, compute_metrics
from ddct_bringup.scores.realtime_run import safe_state, why_not_real_time
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import time_of_step

Entry = dict[str, Any]
"""One run of `scores.json`: bag, ..., valid, reason, metrics, fallbacks, safe_state."""

METRIC_NAMES = tuple(field.name for field in dataclasses.fields(Metrics))
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


def score_recording(recording: Recording, bag: str) -> Entry:
    """
    Score a recording, with the `timing.json` beside it if there is one; `bag` names it.

    Raise DdctError for timing that cannot be used.
    """
    facts = recording.facts
    metrics = compute_metrics(
        recording.trajectory,
        control_start_s=facts.control_start_s,
        score_window_s=facts.score_window_s,
        timing=read_timing(recording.path.parent),
    )
    reason = why_invalid(recording)
    return {
        'bag': bag,
        **{name: getattr(facts, name) for name in _FACT_NAMES},
        'valid': not reason,
        'reason': reason,
        'metrics': metrics.as_dict(),
        'fallbacks': fallbacks_in(recording.trajectory),
        'safe_state': None if facts.lockstep else safe_state(recording),
    }


def unreadable_entry(path: Path, error: DdctError, *, relative_to: Path | None = None) -> Entry:
    """Return the entry of a bag that could not be read: invalid, with the facts it still tells."""
    try:
        facts: RunFacts | None = RunFacts.from_custom_data(
            salvage_records(mcap_of(path)).custom_data
        )
    except DdctError:
        facts = None
    return {
        'bag': bag_name(path, relative_to),
        **{name: getattr(facts, name, None) for name in _FACT_NAMES},
        'valid': False,
        'reason': str(error),
        'metrics': dict.fromkeys(METRIC_NAMES),
        'fallbacks': None,
        'safe_state': None,
    }


def fallbacks_in(trajectory: Trajectory) -> int | None:
    """
    Return at how many steps the controller had no solution of its program and said so.

    None for a controller whose status does not count them.
    """
    count = dict(trajectory.status[-1]).get('fallbacks', '')
    return int(count) if _COUNT.fullmatch(count) else None


def why_invalid(recording: Recording) -> str:
    """Return why a run does not count; empty if it does, also where its engine ended it early."""
    trajectory, facts = recording.trajectory, recording.facts
    reasons = [] if facts.lockstep else why_not_real_time(recording)
    early = trajectory.steps < facts.steps
    if early and not recorded_end_cause(trajectory, recording.custom_data):
        reasons.insert(0, _why_early(recording))
    for name, values in trajectory.signals.items():
        if not isinstance(values, np.ndarray) or np.isfinite(values).all():
            continue
        rows = np.isfinite(values.reshape(len(values), -1)).all(axis=1)
        first = time_of_step(int(np.flatnonzero(~rows)[0]))
        reasons.append(f'non-finite value in {name} at {first:g} s')
    return '; '.join(reasons)


def _why_early(recording: Recording) -> str:
    got, wanted = recording.trajectory.steps, recording.facts.steps
    early = f'ended early: {got} of {wanted} steps'
    if recording.facts.lockstep:
        return early
    if recording.realtime.steps >= wanted:
        return f'{early}: the driveline took them all, but the recorder did not hear the last'
    return f'{early}: the driveline was last heard to count at step {recording.realtime.steps}'


def scores_document(runs: Sequence[Entry]) -> dict[str, list[Entry]]:
    """Return the content of `scores.json`."""
    return {'runs': list(runs)}
