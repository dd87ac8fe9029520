# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The tables of figures and limits and the Pareto view of the report, from entries alone."""

import pytest
from made_scores import made_limit, made_scores

from ddct_bringup.documents.page_parts import unit_text, value_text
from ddct_bringup.evaluation.non_dominated import non_dominated
from ddct_bringup.metrics.catalogue import FIGURES, METRICS, OTHERS, TABLE_5_1
from ddct_bringup.report.pareto import DEFAULT_PAIR, pair_key, pareto_view
from ddct_bringup.report.score_tables import (
    MetricColumn,
    figure_columns,
    limit_columns,
    other_columns,
    table_5_1_columns,
)
from ddct_bringup.scores.scored_recording import ScoredRecording


def run(state='engaged', **values):
    """Return a run of `thesis` with these fields and values of its metrics."""
    return ScoredRecording(made_scores(state=state, **values))


FAILED = ScoredRecording(
    made_scores(
        valid=False,
        reason='killed',
        state='invalid',
        null_reasons=dict.fromkeys(METRICS, 'the run has no scores'),
    )
)
OF_SHIFT = {each.key for each in METRICS.values() if each.of_shift}


def figure_of(key: str, runs: list[ScoredRecording]) -> MetricColumn:
    (column,) = [each for each in figure_columns(runs) if each.metric.key == key]
    return column


def test_every_figure_has_a_column_and_those_of_a_shift_only_beside_a_shift():
    keys = [each.metric.key for each in figure_columns([run()])]
    assert sorted(keys) == sorted(each.key for each in FIGURES if each.key not in OF_SHIFT)
    shifts = [each.metric.key for each in figure_columns([run(), run(shift_time_s=0.8)])]
    assert set(shifts) == {each.key for each in FIGURES}


@pytest.mark.parametrize(
    ('ratio', 'figure'),
    [
        ('peak_jerk_over_least', 'peak_jerk_m_s3'),
        ('friction_work_over_least', 'friction_work_j'),
    ],
)
def test_a_ratio_to_the_least_stands_beside_its_absolute_value(ratio, figure):
    keys = [each.metric.key for each in figure_columns([run()])]
    assert keys.index(ratio) == keys.index(figure) + 1


def test_every_other_metric_but_update_times_is_among_the_further_ones_once():
    shown = table_5_1_columns([run()], [None])
    assert [each.metric for each in shown] == list(TABLE_5_1)
    keys = [each.metric.key for each in (*shown, *other_columns([run()], shown))]
    rest = {each.key for each in OTHERS if each.key not in OF_SHIFT and not each.from_timing}
    assert sorted(keys) == sorted(rest)


def test_a_star_marks_a_ratio_whose_least_is_no_bound():
    why = {'least_is_bound': 'slips again'}
    runs = [run(peak_jerk_over_least=2.0, least_is_bound=True)]
    runs.append(run(peak_jerk_over_least=2.0, least_is_bound=False, null_reasons=why))
    runs.append(run(peak_jerk_over_least=None, least_is_bound=None))
    ratio = figure_of('peak_jerk_over_least', runs)
    assert [cell.yardstick for cell in ratio.cells] == ['', 'slips again', '']
    jerk = figure_of('peak_jerk_m_s3', runs)
    assert [cell.yardstick for cell in jerk.cells] == [''] * 3


def test_every_dash_has_the_reason_of_its_run():
    reasons = {'time_to_final_lock_s': 'the plates are not locked at the end'}
    runs = [run(null_reasons=reasons), FAILED, run(time_to_final_lock_s=1.0)]
    column = figure_of('time_to_final_lock_s', runs)
    expected = [reasons['time_to_final_lock_s'], 'the run has no scores', '']
    assert [cell.why_dash for cell in column.cells] == expected
    assert column.reasons == reasons['time_to_final_lock_s'], 'the failed run has its notice'
    assert not figure_of('releases', [run(releases=0)]).reasons


def limited(value: float | None, **given):
    """Return a run with a weighted acceleration beside a limit of 0.315."""
    key = 'weighted_acceleration_m_s2'
    why = {} if value is not None else {key: 'the run is short'}
    limits = (made_limit(key, value, 0.315, **given),)
    return run(weighted_acceleration_m_s2=value, limits=limits, null_reasons=why)


def test_a_value_beyond_its_limit_is_marked_and_the_limit_has_its_source():
    (column,) = limit_columns([FAILED, limited(0.9), limited(0.3), limited(None), limited(0.315)])
    assert column.metric.key == 'weighted_acceleration_m_s2'
    assert [cell.beyond for cell in column.cells] == [False, True, False, False, False]
    assert [cell.text for cell in column.cells] == ['–', '0.9', '0.3', '–', '0.315']
    why = [cell.why_dash for cell in column.cells]
    assert why == ['the run has no scores', '', '', 'the run is short', '']
    assert (column.limit, column.source, column.convention) == ('0.315', 'A, 1', False)
    assert column.reasons == 'the run is short'
    assert unit_text(column.metric.unit) == 'm/s²'


def test_the_magnitude_of_a_negative_value_is_compared_with_its_limit():
    key = 'mean_negative_jerk_m_s3'
    made = [run(**{key: value}, limits=(made_limit(key, value, 5.0),)) for value in (-6.0, -4.0)]
    (column,) = limit_columns(made)
    assert [cell.beyond for cell in column.cells] == [True, False]


def test_limits_are_in_the_order_of_the_metrics_and_a_metric_without_one_has_no_column():
    limits = (made_limit('judder_rpm', 1.0, 6.0, convention=True), made_limit('releases', 0, 0))
    columns = limit_columns([FAILED, run(judder_rpm=1.0, releases=0, limits=limits)])
    assert [column.metric.key for column in columns] == ['releases', 'judder_rpm']
    assert [column.convention for column in columns] == [False, True]


def test_large_values_keep_every_digit_before_the_point():
    values = (None, 0.07461, 10636.4, 2.2623e14)
    assert [value_text(each) for each in values] == ['–', '0.07461', '10636', '2.262e+14']


def test_a_run_is_dominated_by_one_better_in_one_figure_and_as_good_in_the_other():
    points = {0: (1.0, 3.0), 1: (2.0, 2.0), 2: (2.0, 3.0), 3: (1.0, 3.0), 4: (3.0, 1.0)}
    assert non_dominated(points) == [0, 1, 3, 4]
    assert non_dominated({}) == []


def test_only_engaged_runs_compete_and_magnitudes_count():
    runs = [
        run('stalled', flare_rad_s=-1.0, friction_work_j=5.0),
        run(flare_rad_s=-90.0, friction_work_j=900.0),
        FAILED,
        run(flare_rad_s=20.0, friction_work_j=800.0),
        run('withheld', flare_rad_s=1.0, friction_work_j=1.0),
    ]
    view = pareto_view(runs)
    assert view is not None
    assert view.fronts['flare_rad_s friction_work_j'] == [3]
    assert view.fronts['friction_work_j friction_work_j'] == [3]
    assert list(view.figures['friction_work_j'].values) == [0, 1, 3, 4]


def test_the_view_opens_with_energy_and_jerk_where_runs_have_them():
    runs = [run(releases=each, peak_jerk_m_s3=each, friction_work_j=1 / each) for each in (1, 2)]
    view = pareto_view(runs)
    assert view is not None
    assert view.default == DEFAULT_PAIR
    assert view.fronts[pair_key(*DEFAULT_PAIR)] == [0, 1]
    without = pareto_view([run(torque_late_s=each, releases=each) for each in (1, 2)])
    assert without is not None
    assert without.default == ('torque_late_s', 'releases')


@pytest.mark.parametrize(
    'runs', [[run(releases=1, flare_rad_s=1.0)], [run(releases=1)] * 2, [run(), run()], [FAILED]]
)
def test_there_is_no_view_without_two_runs_in_two_figures(runs):
    assert pareto_view(runs) is None


def test_an_axis_has_the_magnitudes_of_the_runs_and_the_symbol_with_its_unit():
    view = pareto_view([run(flare_rad_s=each, torque_late_s=each) for each in (-900.0, 1000.0)])
    assert view is not None
    axis = view.figures['torque_late_s']
    assert (axis.title, dict(axis.values)) == ('torque late, s', {0: 900.0, 1: 1000.0})
