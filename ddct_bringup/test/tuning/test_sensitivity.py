# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The parameter that decides an objective is found, and one that does not is not."""

import numpy as np
from small_tuning import tuning

from ddct_bringup.tuning.sensitivity import FEWEST, effects_on
from ddct_bringup.tuning.trial import Trial

SPEC = tuning().spec
GOAL = SPEC.objectives[0]


def trials(count: int, noise: float) -> list[Trial]:
    """Return trials whose first objective follows from the proportional gain, at both ends."""
    random = np.random.default_rng(0)
    made = []
    for number in range(count):
        first, second = random.uniform(0.05, 0.5), random.uniform(0.01, 1.0)
        value = (first - 0.25) ** 2 + noise * random.normal()
        row = {'state': 'engaged', GOAL.name: value, SPEC.objectives[1].name: 1.0}
        made.append(Trial(number, {'proportional_gain': first, 'integral_gain': second}, [row]))
    return made


def test_the_parameter_that_decides_explains_most() -> None:
    first, second = effects_on(GOAL, trials(200, 0.0), SPEC)
    assert (first.parameter, second.parameter) == ('proportional_gain', 'integral_gain')
    assert first.explained > 0.8 and first.p_value < 0.01
    assert second.explained < 0.1 and second.p_value > 0.05


def test_chance_explains_nothing() -> None:
    effects = effects_on(GOAL, trials(200, 1e3), SPEC)
    assert all(each.p_value > 0.05 and each.explained < 0.1 for each in effects)


def test_few_trials_say_nothing() -> None:
    assert effects_on(GOAL, trials(FEWEST - 1, 0.0), SPEC) == []
