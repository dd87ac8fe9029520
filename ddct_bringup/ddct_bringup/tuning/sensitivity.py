# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Which parameters decide an objective: the share of its variance that each explains by itself.

The trials are ranked by the objective, and each parameter's range is divided into parts with
equally many trials. The variance of the parts' mean ranks over that of all ranks, freed from what
chance explains (Kelley's epsilon squared), is the first-order effect. A permutation of the ranks
tests whether it is more than chance; the p-values are Holm's.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from ddct_bringup.campaign_report.statistics.attribution import holm
from ddct_bringup.campaign_report.statistics.parts import places_in_range
from ddct_bringup.tuning.specification.goals import Goal
from ddct_bringup.tuning.specification.spec import TuningSpec
from ddct_bringup.tuning.trial import Trial

FEWEST = 20
"""Fewest trials with a value for which effects are computed."""
_IN_PART = 5
"""Smallest number of trials in a part of a parameter's range."""
_PERMUTATIONS = 2000
_SEED = 0
"""Seed of the permutations, so that the same trials give the same figures."""


@dataclass(frozen=True)
class ParameterEffect:
    """Effect of one parameter on one objective."""

    parameter: str
    explained: float
    """Share of the variance of the ranks, 0 to 1."""
    p_value: float


def effects_on(goal: Goal, trials: Sequence[Trial], spec: TuningSpec) -> list[ParameterEffect]:
    """Return the effects of all parameters on an objective, the largest first; none of few."""
    found = [(each, each.estimate(goal, spec)) for each in trials]
    known = [(each, value) for each, value in found if value is not None]
    if len(known) < FEWEST:
        return []
    ranks = scipy.stats.rankdata([value for _, value in known])
    random = np.random.default_rng(_SEED)
    explained, chances = {}, {}
    for parameter in spec.parameters:
        values = np.array([each.values[parameter.name] for each, _ in known], dtype=float)
        parts = places_in_range(values, _IN_PART)
        explained[parameter.name] = _explained(parts, ranks)
        dealt = np.array([random.permutation(ranks) for _ in range(_PERMUTATIONS)])
        as_much = sum(_explained(parts, each) >= explained[parameter.name] for each in dealt)
        chances[parameter.name] = (1 + as_much) / (1 + _PERMUTATIONS)
    corrected = holm(chances)
    effects: list[ParameterEffect] = [
        ParameterEffect(
            parameter=name,
            explained=float(np.clip(value, 0.0, 1.0)),
            p_value=corrected[name],
        )
        for name, value in explained.items()
    ]
    return sorted(effects, key=lambda each: (-each.explained, each.parameter))


def _explained(parts: np.ndarray, ranks: np.ndarray) -> float:
    """Return epsilon squared of (n,) ranks between parts; 0 for equal ranks or a single part."""
    runs = np.bincount(parts)
    total, count = len(ranks), len(runs)
    variance = float(np.sum((ranks - ranks.mean()) ** 2))
    if variance == 0.0 or count < 2 or total <= count:
        return 0.0
    means = np.bincount(parts, ranks) / runs
    between = float(np.sum(runs * (means - ranks.mean()) ** 2))
    return 1.0 - (1.0 - between / variance) * (total - 1) / (total - count)
