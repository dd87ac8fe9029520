# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Scored runs made by hand: a valid run of `pi` in `thesis`, but for what a test gives."""

from typing import Any

from made_run import made_facts

from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.verdict import UNREADABLE, CriterionResult, Verdict

FACTS = ('architecture', 'clutch', 'wear_gain', 'mode', 'seed', 'scenario')
NAMED = (
    *('bag', 'valid', 'reason', 'verdict', 'fallbacks', 'safe_state', 'before_schema'),
    *('scenario_changes', 'gain_changes', 'not_computed', 'over_floor', 'no_floor'),
)


def made_scores(controller: str = 'pi', **values: Any) -> ScoredRun:
    """Return a run with these facts, fields and metrics; the default verdict is UNREADABLE."""
    facts = {name: values.pop(name) for name in FACTS if name in values}
    fields = {name: values.pop(name) for name in NAMED if name in values}
    made = {
        'bag': controller,
        'facts': made_facts(controller=controller, **facts),
        'valid': True,
        'reason': '',
        'metrics': {**dict.fromkeys(METRICS), **values},
        'verdict': UNREADABLE,
        'before_schema': False,
        'scenario_changes': (),
    }
    return ScoredRun(**{**made, **fields})


def made_result(name: str, value: float | None, limit: float | None, **fields: Any) -> Any:
    """Return the result of a criterion, within its limit unless the state is given."""
    made = {'unit': '1', 'source': 'A, 1', 'convention': False, 'state': 'within'}
    return CriterionResult(name=name, value=value, limit=limit, **{**made, **fields})


def made_verdict(state: str = 'engaged', limits: str = 'no_limit', *results: Any) -> Verdict:
    """Return a verdict with these results of criteria, without traction."""
    return Verdict(state, limits, results, None)
