# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The search keeps away from what breaks a constraint, and is the same each time."""

import statistics

import pytest
from small_tuning import tuning

from ddct_bringup.tuning.search import BATCH, Search
from ddct_bringup.tuning.specification.spec import TuningSpec
from ddct_bringup.tuning.trial import Trial

pytest.importorskip('optuna', reason='an extra')
LIMIT = 0.2
"""Proportional gain above which runs break a constraint; a large gain is always better."""


def searched(spec: TuningSpec, batches: int) -> list[float]:
    """Return the proportional gains of all trials of a search whose results are computed here."""
    search, gains = Search(spec, {}), []
    for _ in range(batches):
        trials = []
        for number, values in search.ask(BATCH).items():
            gain = values['proportional_gain']
            row = {
                'state': 'engaged',
                'peak_jerk_m_s3': 1.0 if gain < LIMIT else 9.0,
                **{goal.name: 1.0 / gain for goal in spec.objectives},
            }
            trials.append(Trial(number, values, [row]).checked(spec, 1))
            gains.append(gain)
        search.tell(trials)
    return gains


def test_later_trials_stay_at_the_limit_of_a_constraint() -> None:
    constraints = {'engaged': {'at_least': 0.9}, 'peak_jerk_m_s3': {'at_most': 5.0}}
    late = searched(tuning(constraints=constraints).spec, 12)[-4 * BATCH :]
    assert 0.15 < statistics.median(late) < 0.25


def test_the_same_seed_gives_the_same_trials_and_another_one_others() -> None:
    first, again = (searched(tuning(seed=5).spec, 4) for _ in range(2))
    assert first == again != searched(tuning(seed=6).spec, 4)


def test_values_from_before_are_tried_first_and_unchanged() -> None:
    present = {'proportional_gain': 0.123456789, 'integral_gain': 0.5}
    assert Search(tuning().spec, present).ask(2)[0] == present
