# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Who dominates whom, case by case, from figures that are made by hand or at random."""

from typing import Any

import numpy as np
import pytest
import scipy
from made_benchmarks import COPIES, MadeBenchmark, draws_with_a_dominated_copy

from ddct_bringup.evaluation.case_figures import FIGURES, CaseFigures
from ddct_bringup.evaluation.dominance import (
    compare,
    dominators_of,
    level_among,
    sign_test,
)
from ddct_bringup.metrics.catalogue import METRICS

CASES = 20
NAMES = tuple(each.name for each in FIGURES)
JERK, WORK = NAMES.index('peak_jerk_m_s3'), NAMES.index('friction_work_j')


def figures_of(
    success: Any = True, *, cases: int = CASES, plain: float = 100.0, **values: Any
) -> CaseFigures:
    """Return successes with one plain value everywhere, but for what is given by name."""
    rows = [np.broadcast_to(np.asarray(values.get(name, plain), float), cases) for name in NAMES]
    return CaseFigures(np.broadcast_to(np.asarray(success, bool), cases), np.array(rows))


def counts(first: CaseFigures, second: CaseFigures, name: str) -> tuple[int, int, int]:
    """Return in how many cases the first is better, worse, and left out."""
    found = compare(first, second).figures[name]
    return found.better, found.worse, found.left_out


def test_the_response_is_both_times_and_null_without_one_of_them() -> None:
    columns = {
        'time_to_final_lock_s': np.array([1.0, np.nan, 2.0]),
        'torque_late_s': np.array([0.25, 0.25, np.nan]),
        'peak_jerk_m_s3': np.array([3.0, 4.0, 5.0]),
    }
    response, jerk, *_ = FIGURES
    np.testing.assert_array_equal(response.values_in(columns), [1.25, np.nan, np.nan])
    np.testing.assert_array_equal(jerk.values_in(columns), [3.0, 4.0, 5.0])


def test_the_figures_are_those_of_a_run_by_their_keys_and_units() -> None:
    keys = [key for figure in FIGURES for key in figure.columns]
    assert keys == [
        *('time_to_final_lock_s', 'torque_late_s', 'peak_jerk_m_s3', 'friction_work_j'),
        *('weighted_acceleration_m_s2', 'releases'),
    ]
    assert all(METRICS[key].figure for key in keys)
    units = {METRICS[key].unit for key in FIGURES[0].columns}
    assert units == {FIGURES[0].quantity.unit}


@pytest.mark.parametrize(
    ('name', 'least'),
    [
        ('response_s', 0.02),
        ('peak_jerk_m_s3', 0.1),
        ('friction_work_j', 20.0),
        ('weighted_acceleration_m_s2', 0.01),
        ('releases', 0.5),
    ],
)
def test_a_case_counts_beyond_5_percent_and_beyond_the_least_difference(
    name: str, least: float
) -> None:
    small, large = 4.0 * least, 1000.0 * least  # 5 % of it is less, or more, than the least one
    for larger, margin in ((small, least), (large, 0.05 * large)):
        given: dict[str, Any] = {name: larger}
        theirs = figures_of(cases=2, **given)
        given = {name: [larger - part * margin for part in (0.99, 1.01)]}
        ours = figures_of(cases=2, **given)
        assert counts(ours, theirs, name) == (1, 0, 0)
        assert counts(theirs, ours, name) == (0, 1, 0)


def test_a_failure_is_worse_than_any_success_and_two_failures_tie() -> None:
    ours = figures_of([True, False, False, True], cases=4, plain=1e9)
    theirs = figures_of([False, True, False, True], cases=4, plain=0.0, releases=1e9)
    found = compare(ours, theirs)
    assert [(each.better, each.worse) for each in found.figures.values()] == [(1, 2)] * 4 + [
        (1, 1)
    ]
    missing = figures_of(False, cases=4, plain=np.nan)
    assert counts(missing, theirs, 'releases') == (0, 2, 0)
    assert found.cases == 4


def test_a_figure_that_is_null_by_its_case_leaves_the_case_out_for_both() -> None:
    null = [np.nan, np.nan, np.nan, 1.0]
    ours = figures_of([True, True, False, True], cases=4, response_s=null)
    theirs = figures_of([True, False, False, True], cases=4, response_s=null)
    assert counts(ours, theirs, 'response_s') == counts(theirs, ours, 'response_s') == (0, 0, 2)
    assert counts(ours, theirs, 'releases') == (1, 0, 0)


def test_a_success_that_alone_has_no_value_is_no_better_for_it() -> None:
    ours = figures_of(cases=2, peak_jerk_m_s3=[np.nan, 100.0])
    theirs = figures_of([True, True], cases=2)
    assert counts(ours, theirs, 'peak_jerk_m_s3') == (0, 1, 0)
    assert counts(theirs, ours, 'peak_jerk_m_s3') == (1, 0, 0)


def test_one_figure_that_is_better_suffices_if_none_is_worse() -> None:
    ours, theirs = figures_of(peak_jerk_m_s3=90.0), figures_of()
    assert compare(ours, theirs).dominates(among=COPIES)
    assert not compare(theirs, ours).dominates(among=COPIES)
    assert not compare(ours, ours).dominates(among=2)


def test_a_difference_of_4_percent_in_every_case_is_none() -> None:
    assert not compare(figures_of(plain=96.0), figures_of()).dominates(among=2)


def test_one_figure_that_is_worse_at_5_percent_prevents_it() -> None:
    # Five worse cases without a better one: 1/32; four: 1/16. The median difference is 0 in both.
    for worse, expected in ((5, False), (4, True)):
        work = np.where(np.arange(CASES) < worse, 200.0, 100.0)
        ours = figures_of(peak_jerk_m_s3=90.0, friction_work_j=work)
        assert compare(ours, figures_of()).dominates(among=COPIES) is expected


def test_a_median_difference_that_is_worse_prevents_it() -> None:
    ours = figures_of(peak_jerk_m_s3=90.0, friction_work_j=100.001)
    found = compare(ours, figures_of())
    assert found.figures[NAMES[WORK]].median_difference == pytest.approx(0.001)
    assert found.figures[NAMES[WORK]].p_worse == 1.0
    assert not found.dominates(among=2)


@pytest.mark.parametrize(
    ('factor', 'median', 'worse'), [(1.0 + 1e-12, 0.0, False), (1.0 + 1e-8, 1e-6, True)]
)
def test_a_difference_by_rounding_is_none(factor: float, median: float, worse: bool) -> None:
    """Controllers of the same torque differ by it where they ran on unlike processors."""
    found = compare(figures_of(friction_work_j=100.0 * factor), figures_of())
    work = found.figures[NAMES[WORK]]
    assert work.median_difference == pytest.approx(median)
    assert work.worse_in_median is worse


def test_the_median_difference_counts_failures_as_infinite_and_leaves_null_cases_out() -> None:
    def median(ours: CaseFigures, theirs: CaseFigures) -> tuple[float | None, bool]:
        found = compare(ours, theirs).figures[NAMES[JERK]]
        return found.median_difference, found.worse_in_median

    plain = figures_of(cases=4)
    assert median(figures_of([True, False, False, False], cases=4), plain) == (None, True)
    assert median(plain, figures_of([True, False, False, False], cases=4)) == (None, False)
    ones, others = ([True, True, False, False], [False, False, True, True])
    assert median(figures_of(ones, cases=4), figures_of(others, cases=4)) == (0.0, False)
    values = [np.nan, 101.0, 103.0, 109.0]
    theirs = figures_of(cases=4, peak_jerk_m_s3=[np.nan, 100.0, 100.0, 100.0])
    assert median(figures_of(cases=4, peak_jerk_m_s3=values), theirs) == (3.0, True)
    null = figures_of(cases=4, peak_jerk_m_s3=np.nan)
    assert median(null, null) == (0.0, False)


def test_more_controllers_need_more_cases() -> None:
    """Nine better cases of nine have the p-value 1/512, which is less than .05 / (5 * 2 * 1)."""
    controllers = {
        'better': figures_of(cases=9, peak_jerk_m_s3=90.0),
        'other': figures_of(cases=9),
    }
    assert dominators_of(controllers) == {'better': (), 'other': ('better',)}
    controllers['third'] = figures_of(cases=9, plain=1000.0)
    found = dominators_of(controllers)
    assert found == {'better': (), 'other': (), 'third': ()}  # 1/512 > .05 / (5 * 3 * 2)
    assert level_among(31) == pytest.approx(0.05 / (5 * 31 * 30))


def test_the_sign_test_is_the_binomial_test() -> None:
    for more, fewer in ((0, 0), (0, 7), (7, 0), (5, 2), (150, 120), (180, 120), (330, 0)):
        expected = 1.0
        if more + fewer:
            expected = scipy.stats.binomtest(more, more + fewer, alternative='greater').pvalue
        assert sign_test(more, fewer) == pytest.approx(expected, rel=1e-9)


def test_two_controllers_are_compared_alike_in_both_orders() -> None:
    made = MadeBenchmark(np.random.default_rng(4))
    ours, theirs = made.run(), made.run()
    for one, other in zip(
        compare(ours, theirs).figures.values(),
        compare(theirs, ours).figures.values(),
        strict=True,
    ):
        assert (one.better, one.worse, one.left_out) == (other.worse, other.better, other.left_out)
        assert one.median_difference is not None
        assert other.median_difference is not None
        assert one.median_difference == -other.median_difference
        assert one.better
        assert one.worse


def test_figures_of_another_shape_or_of_other_cases_are_refused() -> None:
    with pytest.raises(ValueError, match=r'\(4, 3\) do not fit 5 figures in 3 cases'):
        CaseFigures(np.ones(3, bool), np.zeros((4, 3)))
    with pytest.raises(ValueError, match='3 cases are not the 4'):
        compare(figures_of(cases=3), figures_of(cases=4))


@pytest.mark.nightly
def test_any_of_thirty_copies_is_seldom_dominated() -> None:
    """A sample of the nightly test; of 20 draws 5 % are one."""
    assert draws_with_a_dominated_copy(20, seed=1) <= 1


def test_a_copy_with_a_tenth_less_jerk_has_significantly_less() -> None:
    made = MadeBenchmark(np.random.default_rng(2))
    better = made.better(made.run(), figure=JERK, by=0.1)
    assert compare(better, made.run()).figures[NAMES[JERK]].p_better < 1e-6
