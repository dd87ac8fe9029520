# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Scored runs made by hand: an engaged run of `pi` in `thesis`, but for what a test gives."""

from dataclasses import fields
from typing import Any

from made_run import made_facts

from ddct_bringup.metrics.catalogue import METRICS
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.limits import LimitResult

FACTS = ('architecture', 'wear_gain', 'mode', 'seed', 'scenario')
NAMED = tuple(each.name for each in fields(ScoredRun) if each.name not in ('facts', 'metrics'))


def made_scores(controller: str = 'pi', **values: Any) -> ScoredRun:
    """Return a run with these facts, fields and metrics; all other metrics are None."""
    facts = {name: values.pop(name) for name in FACTS if name in values}
    named = {name: values.pop(name) for name in NAMED if name in values}
    made = {
        'bag': controller,
        'facts': made_facts(controller=controller, **facts),
        'valid': True,
        'reason': '',
        'metrics': {**dict.fromkeys(METRICS), **values},
        'state': 'engaged',
        'scenario_changes': (),
    }
    return ScoredRun(**{**made, **named})


def made_limit(name: str, value: float | None, limit: float, **given: Any) -> LimitResult:
    """Return the value of a metric beside a limit, a published one unless said otherwise."""
    made = {'unit': METRICS[name].unit, 'source': 'A, 1', 'convention': False}
    return LimitResult(name=name, value=value, limit=limit, **{**made, **given})
