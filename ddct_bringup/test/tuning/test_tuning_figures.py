# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Figures of a tuning have each trial at its values, and room around them."""

from typing import Any

import numpy as np
import pytest

from ddct_bringup.tuning.report.figures import front_figure, sensitivity_figure
from ddct_bringup.tuning.trial import FEASIBLE

TIME, WORK = ({'name': name, 'title': name, 'unit': ''} for name in ('time', 'work'))
VALUES = [(1.0, 30.0), (2.0, 20.0), (4.0, 10.0)]
TRIALS: Any = [
    {
        'number': number,
        'state': FEASIBLE,
        'parameters': {'gain': 0.1 * number},
        'objectives': {'time': time, 'work': work},
    }
    for number, (time, work) in enumerate(VALUES)
]
FRONT = [{'number': each['number'], 'development': each, 'held_out': None} for each in TRIALS[:2]]
RESULT: Any = {
    'objectives': [TIME, WORK],
    'front': FRONT,
    'best': 1,
    'before': None,
    'parameters': {'gain': {'scale': 'linear'}},
}


def test_each_trial_is_at_its_two_objectives() -> None:
    axes = front_figure(RESULT, TRIALS, 0, 1).axes[0]
    np.testing.assert_array_equal(axes.collections[0].get_offsets(), VALUES)
    axes = front_figure(RESULT, TRIALS, 1, 0).axes[0]
    np.testing.assert_array_equal(axes.collections[0].get_offsets(), np.fliplr(VALUES))


@pytest.mark.parametrize('before', [None, FRONT[0]], ids=['none', 'a trial'])
def test_the_legend_names_the_values_of_before_only_where_there_are_some(before: Any) -> None:
    result: Any = {**RESULT, 'before': before}
    (legend,) = front_figure(result, TRIALS, 0, 1).legends
    named = 'before' in [text.get_text() for text in legend.get_texts()]
    assert named == (before is not None)


@pytest.mark.parametrize('goal', [TIME, WORK], ids=['time', 'work'])
def test_the_panel_of_a_parameter_has_all_but_the_highest_tenth_of_the_trials(goal: Any) -> None:
    (panel,) = sensitivity_figure(RESULT, TRIALS, goal).axes
    heights = [each['objectives'][goal['name']] for each in TRIALS]
    low, high = panel.get_ylim()
    assert low < min(heights)
    assert high > np.quantile(heights, 0.9)
