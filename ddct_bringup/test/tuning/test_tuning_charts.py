# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Charts of a tuning have each trial at its values, and room around them."""

from dataclasses import replace
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from extras import needs
from small_tuning import tuning

from ddct_bringup.documents.chart import Chart, Line, Marks, legend
from ddct_bringup.evaluation.share import Share
from ddct_bringup.tuning.report.charts import front_chart, progress_chart, slices_chart
from ddct_bringup.tuning.result import (
    Figures,
    FrontEntry,
    GoalEntry,
    ParameterRange,
    TuningResult,
)
from ddct_bringup.tuning.study import TuningStudy
from ddct_bringup.tuning.trial import Trial

pytestmark = needs('optuna')
SPEC = tuning().spec
TIME, DEVIATION = (
    GoalEntry(goal.name, goal.title, goal.quantity.unit, 'g', goal.sense, None)
    for goal in SPEC.objectives
)
VALUES = [(1.0, 30.0), (2.0, 20.0), (4.0, 10.0), (8.0, 40.0)]
"""Objectives of the trials, of which the last is dominated."""
GAINS = [{'proportional_gain': 0.1 + 0.1 * at, 'integral_gain': 0.2} for at in range(4)]
FRONT = [
    FrontEntry(
        number,
        GAINS[number],
        None,
        Figures({TIME.name: time, DEVIATION.name: deviation}, {}, Share(1, 1), True),
        None,
    )
    for number, (time, deviation) in enumerate(VALUES[:3])
]
RESULT = TuningResult(
    schema_version=2,
    controller='pi',
    parameters={name: ParameterRange(0.0, 1.0, 'linear') for name in GAINS[0]},
    objectives=[TIME, DEVIATION],
    constraints=[],
    trials=4,
    states={},
    reasons={},
    runs=4,
    all_runs=4,
    cases=1,
    held_out_seed=1,
    best=1,
    best_file='best.yaml',
    front=FRONT,
    before=None,
    gaps=(),
    importances={},
)


@pytest.fixture(scope='module')
def study() -> Any:
    """Return the study of the trials."""
    made = TuningStudy(SPEC, {})
    rows = [
        pa.Table.from_pylist([{'state': 'engaged', TIME.name: time, DEVIATION.name: deviation}])
        for time, deviation in VALUES
    ]
    made.add([Trial(number, GAINS[number], each) for number, each in enumerate(rows)])
    return made.study


def scattered(chart: Chart, panel: int = 0) -> set[tuple[float, float]]:
    """Return the places of all trials in a panel."""
    return {
        (float(x), float(y))
        for each in chart.panels[panel].items
        if isinstance(each, Marks)
        for x, y in zip(each.x, each.y, strict=True)
    }


def test_each_trial_is_at_its_two_objectives(study: Any) -> None:
    assert scattered(front_chart(RESULT, study, 0, 1)) >= set(VALUES)
    turned = {(deviation, time) for time, deviation in VALUES}
    assert scattered(front_chart(RESULT, study, 1, 0)) >= turned


@pytest.mark.parametrize('before', [None, FRONT[0]], ids=['none', 'a trial'])
def test_the_legend_names_the_values_of_before_only_where_there_are_some(
    study: Any, before: Any
) -> None:
    chart = front_chart(replace(RESULT, before=before), study, 0, 1)
    assert ('before' in [key.label for key in legend(chart)]) == (before is not None)


@pytest.mark.parametrize(('goal', 'place'), [(TIME, 0), (DEVIATION, 1)], ids=['time', 'std'])
def test_the_panel_of_a_parameter_has_all_but_the_highest_tenth_of_the_trials(
    study: Any, goal: Any, place: int
) -> None:
    chart = slices_chart(RESULT, study, place)
    assert [panel.x.label for panel in chart.panels] == ['integral_gain', 'proportional_gain']
    assert chart.title == goal.title
    heights = [each[place] for each in VALUES]
    gains = [each['proportional_gain'] for each in GAINS]
    assert scattered(chart, 1) >= set(zip(gains, heights, strict=True))
    span = chart.panels[0].y.span
    assert span is not None
    low, high = span
    assert low < min(heights)
    assert np.quantile(heights, 0.9) < high < max(heights)


def test_progress_is_the_volume_between_the_front_and_the_worst_values(study: Any) -> None:
    (line,) = progress_chart(RESULT, study).panels[0].items
    assert isinstance(line, Line)
    # Of (8, 40): 7 x 10, then the part of each further trial that the earlier ones lack.
    np.testing.assert_allclose(line.y, [70.0, 70.0 + 60.0, 130.0 + 40.0, 170.0])


def test_progress_keeps_the_backend_of_matplotlib(study: Any) -> None:
    import matplotlib

    backend = matplotlib.get_backend()
    matplotlib.use('svg')
    try:
        progress_chart(RESULT, study)
        assert matplotlib.get_backend() == 'svg'
    finally:
        matplotlib.use(backend)


def test_progress_of_one_objective_is_its_best_value_so_far(study: Any) -> None:
    alone = replace(RESULT, objectives=[TIME])
    best = progress_chart(alone, study).panels[0].items[-1]
    assert isinstance(best, Line)
    assert (best.x.tolist(), best.y.tolist()) == ([0.0, 1.0, 2.0, 3.0], [1.0] * 4)
