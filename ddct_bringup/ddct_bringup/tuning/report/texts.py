# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Definitions and remarks of the document of a tuning."""

from collections.abc import Iterator

from ddct_bringup.benchmark.report.texts import RULES as BENCHMARK_RULES
from ddct_bringup.documents.document import Terms
from ddct_bringup.tuning.result import TuningResult
from ddct_bringup.tuning.study import FEWEST

RULES = {
    'development': 'The cases on which the trials ran. The search has chosen among many trials by '
    'these very runs, so that their figures flatter.',
    'held out': 'Cases of the same kinds whose seed follows from the digests of the tuned files '
    'and of the release. No trial has seen them: these are the figures to expect.',
    'front': 'Trials that keep all constraints, and that no other such trial equals in every '
    'objective and betters in one.',
    'best': 'The trial of the front that is nearest to the best value of every objective, each '
    'counted from 0 to 1 over the front. The files of the others are in front/.',
    'ended early': 'After a part of the cases a trial ends if it breaks a constraint '
    'or another trial betters it in every objective, whatever its other runs come to. So no trial '
    'of the front is lost.',
    'importance': 'How much the parameter decides the objective, among all parameters: how far '
    'its values in the best quarter of the trials are from those in all trials (PED-ANOVA of '
    'Optuna). The search tries good values more often, so that it is that of the trials, not of '
    'the whole range.',
    'gap': BENCHMARK_RULES['gap'],
}
"""Definitions by term."""


def terms(*names: str) -> Terms:
    """Return the definitions of terms."""
    return Terms({name: RULES[name] for name in names})


def notes_of(result: TuningResult) -> Iterator[str]:
    """Yield what a reader should know before the tables."""
    best = next(each for each in result.front if each.number == result.best)
    if best.held_out and not best.held_out.keeps_constraints:
        yield 'the best trial keeps the constraints on development cases, not on held-out ones'
    if any(each.differs for each in result.gaps):
        yield 'the best trial is worse on held-out cases, beyond chance'
    for name, value in best.parameters.items():
        if end := result.parameters[name].end_near(value):
            yield f'{name} of the best trial, {value:.4g}, is at {end}: widen its range'
    if result.before is None:
        yield 'the values from before are outside of the ranges, and were not tried'
    if result.trials < FEWEST:
        yield f'fewer than {FEWEST} trials: too few to say which parameters decide'
    saved = result.all_runs - result.runs
    yield f'{saved} of {result.all_runs} runs were saved by trials that ended early'
