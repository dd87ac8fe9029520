# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The best trial of the front of a tuning, and why there is none."""

from collections import Counter
from collections.abc import Sequence

import numpy as np

from ddct_bringup.tuning.specification.spec import TuningSpec
from ddct_bringup.tuning.trial import INFEASIBLE, Trial


def best_of(front: Sequence[Trial], spec: TuningSpec) -> Trial:
    """
    Return the trial of a front that is nearest to the best value of every objective.

    Each objective counts from 0, its best value on the front, to 1, its worst one there; of equals
    the first trial is returned.
    """
    costs = np.array([each.costs(spec, len(each.rows)) for each in front])
    low, high = costs.min(axis=0), costs.max(axis=0)
    span = np.where(high > low, high - low, 1.0)
    distances = np.round(np.linalg.norm((costs - low) / span, axis=1), 12)
    return min(zip(distances, front, strict=True), key=lambda pair: (pair[0], pair[1].number))[1]


def why_all_invalid(trials: Sequence[Trial]) -> str:
    """Return the most frequent reason if every run of every trial is invalid, else nothing."""
    tables = [each.rows for each in trials if len(each.rows)]
    if not tables or any(True in table['valid'].to_pylist() for table in tables):
        return ''
    reasons = (reason for table in tables for reason in table['reason'].to_pylist())
    reason, _ = Counter(reasons).most_common(1)[0]
    return f'every run of all {len(trials)} trials is invalid, such as: {reason}'


def why_no_front(trials: Sequence[Trial], spec: TuningSpec) -> str:
    """Return what most trials break, and what the trial that comes nearest breaks, with values."""
    if why := why_all_invalid(trials):
        return why
    reasons = Counter(each.reason for each in trials if each.state == INFEASIBLE)
    title, count = reasons.most_common(1)[0]
    nearest = min(
        (broken for each in trials if (broken := _broken(each, spec)) is not None),
        key=lambda broken: sum(excess for excess, _ in broken),
        default=(),
    )
    values = ' and '.join(text for _, text in nearest)
    found = f'; the nearest trial has {values}' if values else ''
    return (
        f'no trial keeps all constraints: {count} of {len(trials)} break {title}{found}: loosen '
        'that, or widen the ranges'
    )


def _broken(trial: Trial, spec: TuningSpec) -> Sequence[tuple[float, str]] | None:
    """Return by how much a trial breaks which constraints, None where a value is unknown."""
    found = []
    for constraint in spec.constraints:
        value = trial.estimate(constraint.goal, spec)
        if value is None:
            return None
        if constraint.breaks(value):
            text = f'{constraint.goal.title} {value:.4g} for {constraint.title}'
            found.append((constraint.violation(value), text))
    return found
