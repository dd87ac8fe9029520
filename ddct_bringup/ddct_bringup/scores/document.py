# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`scores.json`: scored runs as JSON, written and read."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

from ddct_bringup.bag.run_facts import RunConditions, RunFacts
from ddct_bringup.metrics.catalogue import CRITERIA, METRICS
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.limits import TRACTION, Limits
from ddct_bringup.verdict.verdict import NO_LIMIT, CriterionResult, Verdict
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import steps_in
from ddct_plant.files.input_file import parse_json, read_text_file
from ddct_plant.signals.gain_changes import GainChange

SCHEMA_VERSION = 3
"""
Schema version of `scores.json`.

Version 1 had no verdict and no version number. In version 2 the verdict of a failed run had other
values, and there was no `convention` and no `traction`.
"""
NOT_COMPUTED = 'not_computed'
"""Key of the reasons by metric or criterion; only the log of another tool has it."""
FACTS = tuple(each.name for each in fields(RunConditions))
"""Conditions of a run in its entry, in order."""
_OLDEST = 2
"""Oldest schema version that can be read."""
NO_SUCH_METRIC = 'recorded before this metric existed'
"""Reason for a metric or criterion that stored scores do not have."""


def scores_document(runs: Sequence[ScoredRun], limits: Limits) -> Mapping[str, Any]:
    """Return the content of `scores.json` for runs that were judged by these limits."""
    return {
        'schema_version': SCHEMA_VERSION,
        'limits': limits.origin,
        'runs': [run_entry(run) for run in runs],
    }


def run_entry(run: ScoredRun) -> Mapping[str, Any]:
    """Return the entry of one run."""
    entry = {
        'bag': run.bag,
        **{name: getattr(run.facts, name, None) for name in FACTS},
        **(run.facts.of_shift if isinstance(run.facts, RunFacts) else {}),
        'valid': run.valid,
        'reason': run.reason,
        'metrics': dict(run.metrics),
        'verdict': verdict_entry(run.verdict),
        'fallbacks': run.fallbacks,
        'safe_state': run.safe_state,
        'before_schema': run.before_schema,
        'scenario_changes': None if run.scenario_changes is None else list(run.scenario_changes),
        'gain_changes': [gain_change_entry(each) for each in run.gain_changes],
        'over_floor': dict(run.over_floor),
        'no_floor': run.no_floor,
    }
    return {**entry, NOT_COMPUTED: dict(run.not_computed)} if run.measured else entry


def gain_change_entry(change: GainChange) -> Mapping[str, Any]:
    """Return the entry of a gain that was changed in a run, in force from `time_s` in s on."""
    values = {'gain': change.gain, 'before': change.before, 'after': change.after}
    return {**values, 'time_s': change.time_s}


def verdict_entry(verdict: Verdict) -> Mapping[str, Any]:
    """Return the entry of a verdict; that of the traction has no name."""
    traction = verdict.traction
    return {
        'state': verdict.state,
        'limits': verdict.limits,
        'criteria': [asdict(each) for each in verdict.criteria],
        'traction': None if traction is None else _without_name(traction),
    }


def _without_name(result: CriterionResult) -> Mapping[str, Any]:
    return {key: value for key, value in asdict(result).items() if key != 'name'}


def read_scores(path: str | Path) -> list[ScoredRun]:
    """
    Return the runs in a `scores.json`, that of an earlier version included.

    A metric or criterion that the file does not have is None, with `NO_SUCH_METRIC` as its reason.
    Raise DdctError for a file that cannot be read, or that is no `scores.json` of version 2 or 3.
    """
    try:
        content = parse_json(read_text_file(Path(path)))
        version = content['schema_version']
        if not _OLDEST <= version <= SCHEMA_VERSION:
            raise DdctError(f'schema_version is {version}, not {_OLDEST} to {SCHEMA_VERSION}')
        return [_run_of(entry) for entry in content['runs']]
    except OSError as error:
        raise DdctError(f'{path}: cannot read the scores: {error.strerror}') from error
    except (DdctError, LookupError, TypeError, AttributeError) as error:
        raise DdctError(
            f'not the scores of runs ({error!r}): score the bags again with ddct score', place=path
        ) from error


def _run_of(entry: Mapping[str, Any]) -> ScoredRun:
    verdict = _verdict_of(entry['verdict'])
    metrics = entry['metrics']
    of_verdict = (each.key for each in CRITERIA if each.key not in verdict.values)
    # Older scores are of no gear shift, so that its metrics are null as in any other run.
    missing = [key for key in METRICS if key not in metrics and not METRICS[key].of_shift]
    missing += of_verdict if verdict.criteria else ()
    changes = entry['scenario_changes']
    return ScoredRun(
        bag=entry['bag'],
        facts=RunConditions(**{name: entry[name] for name in FACTS})
        if entry['controller'] is not None
        else None,
        valid=entry['valid'],
        reason=entry['reason'],
        metrics={key: metrics.get(key) for key in METRICS},
        verdict=verdict,
        fallbacks=entry['fallbacks'],
        safe_state=entry['safe_state'],
        before_schema=entry['before_schema'],
        scenario_changes=None if changes is None else tuple(changes),
        gain_changes=tuple(_gain_change_of(each) for each in entry.get('gain_changes', ())),
        over_floor=entry.get('over_floor', {}),
        no_floor=entry.get('no_floor', ''),
        not_computed={**dict.fromkeys(missing, NO_SUCH_METRIC), **entry.get(NOT_COMPUTED, {})},
    )


def _gain_change_of(entry: Mapping[str, Any]) -> GainChange:
    step = steps_in('time_s', entry['time_s'])
    return GainChange(entry['gain'], entry['before'], entry['after'], step)


def _verdict_of(entry: Mapping[str, Any]) -> Verdict:
    traction = entry.get(TRACTION)
    return Verdict(
        entry['state'],
        entry['limits'],
        tuple(_result_of(each) for each in entry['criteria']),
        None if traction is None else _result_of({**traction, 'name': TRACTION}),
    )


def _result_of(entry: Mapping[str, Any]) -> CriterionResult:
    older = {'convention': False, 'state': NO_LIMIT}
    known = {each.name for each in fields(CriterionResult)}
    return CriterionResult(**{**older, **{key: entry[key] for key in entry if key in known}})
