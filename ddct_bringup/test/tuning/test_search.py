# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The search keeps away from what breaks a constraint, and is the same each time."""

import statistics
from dataclasses import replace
from pathlib import Path

import pyarrow as pa
import pytest
from extras import needs
from refusals import refused
from small_tuning import tuning

from ddct_bringup.tuning.specification.parameters import Values
from ddct_bringup.tuning.specification.spec import TuningSpec
from ddct_bringup.tuning.study import BATCH, JOURNAL, TuningStudy, read_trials
from ddct_bringup.tuning.trial import DOMINATED, FEASIBLE, INFEASIBLE, Trial
from ddct_plant.base.errors import DdctError

pytestmark = needs('optuna')
LIMIT = 0.2
"""Proportional gain above which runs break a constraint; a large gain is always better."""


def searched(spec: TuningSpec, batches: int) -> list[float]:
    """Return the proportional gains of all trials of a search whose results are computed here."""
    study, gains = TuningStudy(spec, {}), []
    for batch in range(batches):
        trials = []
        for number, values in study.ask(batch, BATCH).items():
            gain = values['proportional_gain']
            row = {
                'state': 'engaged',
                'peak_jerk_m_s3': 1.0 if gain < LIMIT else 9.0,
                **{goal.name: 1.0 / gain for goal in spec.objectives},
            }
            rows = pa.Table.from_pylist([row])
            trials.append(Trial(number, values, rows).checked(spec, 1))
            gains.append(gain)
        study.add(trials)
    return gains


@pytest.mark.nightly
def test_later_trials_stay_at_the_limit_of_a_constraint() -> None:
    constraints = {'engaged': {'at_least': 0.9}, 'peak_jerk_m_s3': {'at_most': 5.0}}
    late = searched(tuning(constraints=constraints).spec, 12)[-4 * BATCH :]
    assert 0.15 < statistics.median(late) < 0.25


def test_the_same_seed_gives_the_same_trials_and_another_one_others() -> None:
    first, again = (searched(tuning(seed=5).spec, 4) for _ in range(2))
    assert first == again != searched(tuning(seed=6).spec, 4)


def test_the_search_follows_the_results_after_the_trials_at_random() -> None:
    spec, asked = tuning().spec, []
    for best in (0, 15):
        study = TuningStudy(spec, {})
        for batch in range(2):
            found = study.ask(batch, BATCH).items()
            study.add([trial(number, spec, each, abs(number - best)) for number, each in found])
        asked.append(([each.values for each in study.trials], study.ask(2, BATCH)))
    (tried, first), (also, second) = asked
    assert tried == also
    assert first != second


def test_values_from_before_are_tried_first_and_unchanged() -> None:
    present = {'proportional_gain': 0.123456789, 'integral_gain': 0.5}
    assert TuningStudy(tuning().spec, present).ask(0, 2)[0] == present


def test_a_batch_is_the_same_in_a_study_that_was_opened_again_and_after_a_part_of_it(
    tmp_path: Path,
) -> None:
    spec = tuning().spec
    study = TuningStudy(spec, {}, tmp_path)
    whole = study.ask(0, BATCH)
    study.add([trial(number, spec, values) for number, values in whole.items()])
    asked = study.ask(1, BATCH)
    (tmp_path / f'{JOURNAL}.lock').touch()
    with (tmp_path / JOURNAL).open('a') as journal:
        journal.write('{"op_code": 4, "worker')  # the line that a killed program began
    again = TuningStudy(spec, {}, tmp_path)
    assert again.ask(1, BATCH) == asked
    again.add([trial(number, spec, asked[number]) for number in range(BATCH, BATCH + 3)])
    assert [each.values for each in again.trials] == [*whole.values(), *list(asked.values())[:3]]
    assert TuningStudy(spec, {}, tmp_path).ask(1, BATCH) == asked


def test_a_trial_is_read_as_it_was_added(tmp_path: Path) -> None:
    spec = tuning().spec
    values = {'proportional_gain': 0.1, 'integral_gain': 0.25}
    further = {'unstable_corners': 2.0, 'corner_sensitivity_peak': None}
    states = ((FEASIBLE, ''), (INFEASIBLE, 'engaged at least 0.9'), (DOMINATED, 'another one'))
    study = TuningStudy(spec, {}, tmp_path)
    study.add(
        [
            replace(trial(number, spec, values), state=state, reason=reason, further=further)
            for number, (state, reason) in enumerate(states)
        ]
    )
    read = read_trials(tmp_path)
    assert [(each.number, each.state, each.reason) for each in read] == [
        (number, *each) for number, each in enumerate(states)
    ]
    assert all((each.values, each.further) == (values, further) for each in read)
    assert study.front() == [0]


def trial(number: int, spec: TuningSpec, values: Values, result: float = 1.0) -> Trial:
    """Return a feasible trial of one run; `result` is the value of the first objective."""
    first, *others = (goal.name for goal in spec.objectives)
    row = {'state': 'engaged', first: result, **dict.fromkeys(others, 1.0)}
    return Trial(number, values, pa.Table.from_pylist([row]))


@pytest.mark.parametrize('damage', ['', 'no journal\n', '{"op_code": 77}\n', '[1]\n\n{}\n'])
def test_a_damaged_study_is_refused_with_its_file(tmp_path: Path, damage: str) -> None:
    (tmp_path / JOURNAL).write_text(damage, encoding='utf-8')
    with refused(DdctError, place=str(tmp_path / JOURNAL)):
        read_trials(tmp_path)


def test_an_absent_study_is_refused_and_not_made(tmp_path: Path) -> None:
    with refused(DdctError, place=str(tmp_path / JOURNAL)):
        read_trials(tmp_path)
    assert not (tmp_path / JOURNAL).exists()
