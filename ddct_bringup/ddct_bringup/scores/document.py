# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""`scores.json`: scored runs as JSON."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.limits import Limits
from ddct_bringup.verdict.verdict import CriterionResult, Verdict

SCHEMA_VERSION = 3
"""
Schema version of `scores.json`.

Version 1 had no verdict and no version number. In version 2 the verdict of a failed run had other
values, and there was no `convention` and no `traction`.
"""
NOT_COMPUTED = 'not_computed'
"""Key of the reasons by metric or criterion; only the log of another tool has it."""
FACTS = ('controller', 'architecture', 'scenario', 'clutch', 'wear_gain', 'mode', 'seed')
"""Facts of a run in its entry, in order."""


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
        'valid': run.valid,
        'reason': run.reason,
        'metrics': dict(run.metrics),
        'verdict': verdict_entry(run.verdict),
        'fallbacks': run.fallbacks,
        'safe_state': run.safe_state,
        'before_schema': run.before_schema,
        'scenario_changes': None if run.scenario_changes is None else list(run.scenario_changes),
    }
    return {**entry, NOT_COMPUTED: dict(run.not_computed)} if run.measured else entry


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
