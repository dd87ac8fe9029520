# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The front, the best trial on it, and the reason why there is none."""

from collections.abc import Sequence
from typing import Any

import pyarrow as pa
import pytest
from small_tuning import tuning

from ddct_bringup.tuning.front import best_of, why_no_front
from ddct_bringup.tuning.study import TuningStudy
from ddct_bringup.tuning.trial import FEASIBLE, INFEASIBLE, State, Trial

SPEC = tuning().spec


def trial(number: int, *values: float, status: State = FEASIBLE, **row: Any) -> Trial:
    """Return a trial of one run with these objectives."""
    names = [goal.name for goal in SPEC.objectives]
    made = {'state': 'engaged', 'valid': True, 'reason': '', **row}
    rows = pa.Table.from_pylist([{**made, **dict(zip(names, values, strict=True))}])
    why = 'engaged at least 0.9' if status != FEASIBLE else ''
    tried = {'proportional_gain': 0.1, 'integral_gain': 0.1}
    return Trial(number, tried, rows, {}, status, why)


def front_of(trials: Sequence[Trial]) -> list[int]:
    """Return the numbers of the trials on the front."""
    pytest.importorskip('optuna', reason='an extra')
    study = TuningStudy(SPEC, {})
    study.add(trials)
    return study.front()


def test_the_front_has_what_no_other_dominates_by_the_first_objective() -> None:
    trials = [trial(0, 3.0, 1.0), trial(1, 1.0, 3.0), trial(2, 3.0, 3.0), trial(3, 2.0, 2.0)]
    assert front_of(trials) == [1, 3, 0]


def test_an_infeasible_trial_is_not_on_the_front_and_pushes_none_off() -> None:
    trials = [trial(0, 3.0, 1.0), trial(1, 1.0, 0.5, status=INFEASIBLE)]
    assert front_of(trials) == [0]


def test_equal_trials_are_both_on_the_front() -> None:
    assert front_of([trial(0, 1.0, 1.0), trial(1, 1.0, 1.0)]) == [0, 1]


def test_the_best_is_nearest_to_the_best_of_every_objective() -> None:
    front = [trial(4, 1.0, 300.0), trial(5, 2.0, 120.0), trial(6, 11.0, 100.0)]
    assert best_of(front, SPEC).number == 5
    assert best_of(front[:1], SPEC).number == 4


def test_the_best_is_the_same_when_an_objective_has_another_origin() -> None:
    for origin in (0.0, 100.0):
        front = [trial(4, origin, 2.0), trial(5, origin + 0.3, 1.2), trial(6, origin + 1.0, 1.0)]
        assert best_of(front, SPEC).number == 5


@pytest.mark.filterwarnings('error')
def test_the_best_of_equal_trials_is_the_first() -> None:
    assert best_of([trial(5, 1.0, 2.0), trial(4, 1.0, 2.0)], SPEC).number == 4


@pytest.mark.parametrize(
    ('row', 'words'),
    [
        ({'valid': False, 'reason': 'it fell over'}, 'it fell over'),
        (
            {'state': 'stalled'},
            'engaged at least 0.9; the nearest trial has engaged 0 for engaged at least 0.9',
        ),
    ],
)
def test_without_a_front_the_reason_is_named(row: dict[str, Any], words: str) -> None:
    assert words in why_no_front([trial(0, 1.0, 1.0, status=INFEASIBLE, **row)], SPEC)
