# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Figures of a tuning have each trial at its values, and room around them."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from ddct_bringup.tuning.report.figures import front_figure, sensitivity_figure
from ddct_bringup.tuning.result import (
    Figures,
    FrontEntry,
    GoalEntry,
    ParameterRange,
    TuningResult,
)
from ddct_bringup.tuning.trial import FEASIBLE, TrialEntry

TIME, WORK = (GoalEntry(name, name, '', 'g', 'minimise', None) for name in ('time', 'work'))
VALUES = [(1.0, 30.0), (2.0, 20.0), (4.0, 10.0)]
TRIALS = [
    TrialEntry(
        number, {'gain': 0.1 * number}, FEASIBLE, '', 1, {'time': time, 'work': work}, {}, {}
    )
    for number, (time, work) in enumerate(VALUES)
]
FRONT = [
    FrontEntry(
        each.number, each.parameters, None, Figures(each.objectives, {}, 1.0, 1, True), None
    )
    for each in TRIALS[:2]
]
RESULT = TuningResult(
    schema_version=1,
    controller='pi',
    parameters={'gain': ParameterRange(0.0, 1.0, 'linear')},
    objectives=[TIME, WORK],
    constraints=[],
    trials=3,
    states={},
    reasons={},
    runs=3,
    all_runs=3,
    cases=1,
    held_out_seed=1,
    best=1,
    best_file='best.yaml',
    front=FRONT,
    before=None,
    gaps=[],
    sensitivity={},
    convergence={},
)


def test_each_trial_is_at_its_two_objectives() -> None:
    axes = front_figure(RESULT, TRIALS, 0, 1).axes[0]
    np.testing.assert_array_equal(axes.collections[0].get_offsets(), VALUES)
    axes = front_figure(RESULT, TRIALS, 1, 0).axes[0]
    np.testing.assert_array_equal(axes.collections[0].get_offsets(), np.fliplr(VALUES))


@pytest.mark.parametrize('before', [None, FRONT[0]], ids=['none', 'a trial'])
def test_the_legend_names_the_values_of_before_only_where_there_are_some(before: Any) -> None:
    (legend,) = front_figure(replace(RESULT, before=before), TRIALS, 0, 1).legends
    named = 'before' in [text.get_text() for text in legend.get_texts()]
    assert named == (before is not None)


@pytest.mark.parametrize('goal', [TIME, WORK], ids=['time', 'work'])
def test_the_panel_of_a_parameter_has_all_but_the_highest_tenth_of_the_trials(goal: Any) -> None:
    (panel,) = sensitivity_figure(RESULT, TRIALS, goal).axes
    heights = [each.objectives[goal.name] for each in TRIALS]
    low, high = panel.get_ylim()
    assert low < min(heights)
    assert high > np.quantile(heights, 0.9)
