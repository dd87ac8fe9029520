# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The parameter that decides an objective is found, and one that does not is not."""

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


def study(count: int, noise: float) -> TuningStudy:
    """Return a study whose first objective follows from the proportional gain, at both ends."""
    random = np.random.default_rng(0)
    made = []
    for number in range(count):
        first, second = random.uniform(0.05, 0.5), random.uniform(0.01, 1.0)
        value = (first - 0.25) ** 2 + noise * random.normal()
        row = {'state': 'engaged', GOAL.name: value, SPEC.objectives[1].name: 1.0}
        values = {'proportional_gain': first, 'integral_gain': second}
        made.append(Trial(number, values, pa.Table.from_pylist([row])))
    found = TuningStudy(SPEC, {})
    found.add(made)
    return found


def test_the_parameter_that_decides_is_the_most_important() -> None:
    found = study(200, 0.0).importances(0)
    assert list(found) == ['proportional_gain', 'integral_gain']
    assert found['proportional_gain'] > 0.8
    assert sum(found.values()) == pytest.approx(1.0)


def test_of_chance_no_parameter_is_far_more_important() -> None:
    assert max(study(200, 1e3).importances(0).values()) < 0.8


def test_few_trials_say_nothing() -> None:
    assert study(FEWEST - 1, 0.0).importances(0) == {}
    assert study(FEWEST, 0.0).importances(0)
