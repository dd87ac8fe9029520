# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`scores.json`: scored runs as JSON, written and read."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

from ddct_bringup.bag.run_facts import RunConditions, RunFacts
from ddct_bringup.metrics.catalogue import FIGURES, METRICS, OTHERS
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.limits import LimitResult, Limits
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import steps_in
from ddct_plant.files.input_file import read_text_file
from ddct_plant.files.json_records import parse_json
from ddct_plant.signals.gain_changes import GainChange

SCHEMA_VERSION = 4
"""Schema version of `scores.json`."""
FACTS = tuple(each.name for each in fields(RunConditions))
"""Conditions of a run in its entry, in order."""


def scores_document(runs: Sequence[ScoredRun], limits: Limits) -> Mapping[str, Any]:
    """Return the content of `scores.json` for runs that were judged by these limits."""
    return {
        'schema_version': SCHEMA_VERSION,
        'limits': limits.origin,
        'runs': [run_entry(run) for run in runs],
    }


def run_entry(run: ScoredRun) -> Mapping[str, Any]:
    """Return the entry of one run; metrics of a gear shift only where it is one."""
    shown = {each.key for each in METRICS.values() if run.is_shift or not each.of_shift}
    return {
        'bag': run.bag,
        **{name: getattr(run.facts, name, None) for name in FACTS},
        **(run.facts.of_shift if isinstance(run.facts, RunFacts) else {}),
        'valid': run.valid,
        'reason': run.reason,
        'state': run.state,
        'why': run.why,
        'figures': figures_entry(run),
        'metrics': {each.key: run.metrics[each.key] for each in OTHERS if each.key in shown},
        'limits': [asdict(each) for each in run.limits],
        'null_reasons': {key: why for key, why in run.null_reasons.items() if key in shown},
        'fallbacks': run.fallbacks,
        'safe_state': run.safe_state,
        'scenario_changes': None if run.scenario_changes is None else list(run.scenario_changes),
        'gain_changes': [gain_change_entry(each) for each in run.gain_changes],
    }


def gain_change_entry(change: GainChange) -> Mapping[str, Any]:
    """Return the entry of a gain that was changed in a run, in force from `time_s` in s on."""
    values = {'gain': change.gain, 'before': change.before, 'after': change.after}
    return {**values, 'time_s': change.time_s}


def figures_entry(run: ScoredRun) -> Mapping[str, float | bool | None]:
    """Return the figures of a run by key; those of a gear shift only where it is one."""
    figures: dict[str, float | bool | None] = {
        each.key: run.metrics[each.key] for each in FIGURES if run.is_shift or not each.of_shift
    }
    return {**figures, 'least_is_bound': run.least_is_bound}


def read_scores(path: str | Path) -> list[ScoredRun]:
    """Return the runs in a `scores.json`; raise DdctError for a file that is none."""
    try:
        content = parse_json(read_text_file(Path(path)))
        version = content['schema_version']
        if version != SCHEMA_VERSION:
            raise DdctError(f'schema_version is {version}, not {SCHEMA_VERSION}')
        return [_run_of(entry) for entry in content['runs']]
    except OSError as error:
        raise DdctError(f'{path}: cannot read the scores: {error.strerror}') from error
    except (DdctError, LookupError, TypeError, AttributeError) as error:
        raise DdctError(
            f'not the scores of runs ({error!r}): score the bags again with ddct score', place=path
        ) from error


def _run_of(entry: Mapping[str, Any]) -> ScoredRun:
    changes = entry['scenario_changes']
    figures = entry['figures']
    return ScoredRun(
        bag=entry['bag'],
        facts=RunConditions(**{name: entry[name] for name in FACTS})
        if entry['controller'] is not None
        else None,
        valid=entry['valid'],
        reason=entry['reason'],
        metrics={key: {**entry['metrics'], **figures}.get(key) for key in METRICS},
        state=entry['state'],
        why=entry['why'],
        limits=tuple(LimitResult(**each) for each in entry['limits']),
        fallbacks=entry['fallbacks'],
        safe_state=entry['safe_state'],
        scenario_changes=None if changes is None else tuple(changes),
        gain_changes=tuple(_gain_change_of(each) for each in entry['gain_changes']),
        null_reasons=entry['null_reasons'],
        least_is_bound=figures['least_is_bound'],
    )


def _gain_change_of(entry: Mapping[str, Any]) -> GainChange:
    step = steps_in('time_s', entry['time_s'])
    return GainChange(entry['gain'], entry['before'], entry['after'], step)
