# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The chart of a campaign: curves that end at the share of engaged runs, with title and scale."""

from itertools import pairwise

import numpy as np
import pytest
from made_results import made_results

from ddct_bringup.campaign_report.distributions_chart import distributions_chart
from ddct_bringup.documents.chart import Line
from ddct_bringup.documents.chart_files import matplotlib_figure
from ddct_bringup.verdict.state import ENGAGED, INVALID

JERK = 'peak_jerk_m_s3'


def curves(results):
    """Return the curves of the only panel by label."""
    chart = distributions_chart(results, 'thesis')
    (panel,) = chart.panels
    return {
        line.label: np.column_stack([line.x, line.y])
        for line in panel.items
        if isinstance(line, Line)
    }, chart


def test_a_curve_rises_by_a_run_at_its_value_and_ends_at_the_share_of_engaged_runs():
    results = made_results(
        [ENGAGED, ENGAGED, 'stalled', INVALID],
        {'wear_gain': [0.7, 0.8, 0.9, 1.0]},
        {JERK: [9.0, 4.0, 1.0, 2.0]},
    )
    drawn, chart = curves(results)
    assert drawn['pi'].tolist() == [[4.0, 0.0], [4.0, 1 / 3], [9.0, 2 / 3]]
    assert chart.panels[0].x.label == 'peak jerk, m/s\u00b3'
    assert chart.title == 'Scenario thesis: 4 runs over wear_gain'
    assert 'points of a grid, not chances' in chart.conditions


def test_each_controller_has_a_curve_also_one_that_never_engaged():
    results = made_results(
        [ENGAGED, 'stalled'],
        {'wear_gain': [1.0, 1.0]},
        {JERK: [4.0, 5.0]},
        controllers=['pi', 'ls8'],
        random=['wear_gain'],
    )
    drawn, chart = curves(results)
    assert sorted(drawn) == ['ls8', 'pi']
    assert len(drawn['ls8']) == 0
    assert 'random samples' in chart.conditions


def test_a_curve_of_very_many_runs_keeps_its_ends():
    runs = 3000
    values = np.random.default_rng(0).normal(size=runs)
    results = made_results(
        [ENGAGED] * runs,
        {'wear_gain': np.arange(runs).tolist()},
        {JERK: values.tolist()},
        random=['wear_gain'],
    )
    drawn, _ = curves(results)
    curve = drawn['pi']
    assert len(curve) < 600
    assert (curve[0, 0], curve[-1, 0]) == (values.min(), values.max())
    assert curve[-1, 1] == pytest.approx(1.0)


def test_the_first_panel_is_that_of_the_response():
    results = made_results(
        [ENGAGED] * 2,
        {'wear_gain': [0.7, 0.8]},
        {JERK: [4.0, 5.0], 'time_to_final_lock_s': [0.5, 0.6], 'torque_late_s': [0.1, 0.2]},
    )
    response, *_ = distributions_chart(results, 'thesis').panels
    assert response.x.label == 'response, s'
    (curve,) = response.items
    assert isinstance(curve, Line)
    assert curve.x == pytest.approx([0.6, 0.6, 0.8])


def test_each_panel_of_a_file_names_its_metric_and_has_numbers_below():
    metrics = ['time_to_final_lock_s', 'torque_late_s', JERK, 'friction_work_j']
    results = made_results(
        [ENGAGED] * 2, {'wear_gain': [0.7, 0.8]}, {key: [4.0, 5.0] for key in metrics}
    )
    figure = matplotlib_figure(distributions_chart(results, 'thesis'))
    drawn = figure.axes[:5]
    labels = [axes.get_xlabel() for axes in drawn]
    assert all(labels)
    assert len({*labels}) == 5
    assert all(axes.xaxis.get_tick_params()['labelbottom'] for axes in drawn)
    assert [bool(axes.get_ylabel()) for axes in drawn] == [True, False, False, True, False]


@pytest.mark.slow
@pytest.mark.parametrize('highest', [0.0123, 9.9, 123.0, 100_000.0, 123_456.0, 987_654.0])
def test_tick_labels_of_the_x_axis_do_not_overlap(highest):
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    results = made_results(
        [ENGAGED, ENGAGED],
        {'wear_gain': [0.7, 0.8]},
        {'friction_work_j': [0.2 * highest, highest]},
    )
    figure = matplotlib_figure(distributions_chart(results, 'thesis'))
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    axis = figure.axes[0].xaxis
    low, high = axis.get_view_interval()
    ticks = [tick for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]
    boxes = [tick.label1.get_window_extent(canvas.get_renderer()) for tick in ticks]
    assert 2 <= len(ticks) <= 5
    assert all(left.x1 < right.x0 for left, right in pairwise(boxes))
