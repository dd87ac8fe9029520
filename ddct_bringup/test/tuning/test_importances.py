# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The parameter that decides an objective is found, and one that does not is not."""

from collections.abc import Iterable

import numpy as np
import pyarrow as pa
import pytest
from extras import needs
from small_tuning import tuning

from ddct_bringup.tuning.study import FEWEST, TuningStudy
from ddct_bringup.tuning.trial import Trial

pytestmark = needs('optuna')
SPEC = tuning().spec
GOAL = SPEC.objectives[0]


def study(values: Iterable[tuple[float, float, float]]) -> TuningStudy:
    """Return a study with trials of two gains and the value of the first objective."""
    made = []
    for number, (first, second, value) in enumerate(values):
        row = {'state': 'engaged', GOAL.name: value, SPEC.objectives[1].name: 1.0}
        gains = {'proportional_gain': first, 'integral_gain': second}
        made.append(Trial(number, gains, pa.Table.from_pylist([row])))
    found = TuningStudy(SPEC, {})
    found.add(made)
    return found


def of_the_first(count: int, noise: float) -> TuningStudy:
    """Return a study whose first objective follows from the proportional gain, at both ends."""
    random = np.random.default_rng(0)
    values = []
    for _ in range(count):
        first, second = random.uniform(0.05, 0.5), random.uniform(0.01, 1.0)
        values.append((first, second, (first - 0.25) ** 2 + noise * random.normal()))
    return study(values)


def test_the_parameter_that_decides_is_the_most_important() -> None:
    found = of_the_first(200, 0.0).importances(0)
    assert list(found) == ['proportional_gain', 'integral_gain']
    assert found['proportional_gain'] > 0.8
    assert sum(found.values()) == pytest.approx(1.0)


def test_of_chance_no_parameter_is_far_more_important() -> None:
    assert max(of_the_first(200, 1e3).importances(0).values()) < 0.8


def test_the_best_quarter_of_the_trials_decides() -> None:
    """The integral gain decides which half is the best one, both gains which quarter is."""
    places = [(first, second) for first in range(8) for second in range(8)]
    found = study(
        (0.05 + 0.06 * first, 0.05 + 0.12 * second, float(second > 3) + 0.5 * (first > 3))
        for first, second in places
    ).importances(0)
    assert found['proportional_gain'] == pytest.approx(found['integral_gain'], rel=0.1)


def test_few_trials_say_nothing() -> None:
    assert of_the_first(FEWEST - 1, 0.0).importances(0) == {}
    assert of_the_first(FEWEST, 0.0).importances(0)
