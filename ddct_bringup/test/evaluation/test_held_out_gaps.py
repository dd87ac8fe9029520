# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Gaps between development and held-out cases, by ranks within scenarios."""

import itertools
from statistics import NormalDist

import numpy as np
import pytest
import scipy
from made_benchmarks import IN_SCENARIO, MadeBenchmark, flagged_draws
from samples import sampled

from ddct_bringup.evaluation.case_figures import FIGURES, CaseFigures
from ddct_bringup.evaluation.held_out_gaps import gaps_of, van_elteren


def z_of(p_value: float | None) -> float:
    """Return the normal deviate of a one-sided p-value."""
    assert p_value is not None
    return NormalDist().inv_cdf(1.0 - p_value)


def test_one_stratum_has_the_textbook_value_of_the_rank_sum_test() -> None:
    """
    Permeability of human chorioamnion: Hollander and Wolfe 1973, page 69.

    The sum of pairs in which the first sample is larger is 35 of 50, with the normal deviate
    (35 - 25) / sqrt(10 * 5 * 16 / 12).
    """
    at_term = np.array([0.80, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46])
    early = np.array([1.15, 0.88, 0.90, 0.74, 1.21])
    p_value, worse = van_elteren([(early, at_term)])
    assert z_of(p_value) == pytest.approx(1.2247, abs=1e-4)
    assert worse == pytest.approx(0.7)


def test_two_strata_of_many_ties_have_the_textbook_value() -> None:
    """
    Migraine by treatment and sex: Stokes, Davis and Koch, Categorical Data Analysis.

    The Cochran-Mantel-Haenszel statistic is 8.3052 there, with the same weight for both strata.
    Here they have 52 and 54 patients, so that the weights differ by less than 1 in 1000.
    """
    better, same = 0.0, 1.0
    women = (np.repeat([better, same], [16, 11]), np.repeat([better, same], [5, 20]))
    men = (np.repeat([better, same], [12, 16]), np.repeat([better, same], [7, 19]))
    p_value, worse = van_elteren([women, men])
    assert z_of(p_value) ** 2 == pytest.approx(8.3052, rel=5e-4)
    assert worse is not None
    assert worse > 0.5


def test_one_stratum_with_ties_is_the_mann_whitney_test() -> None:
    random = np.random.default_rng(3)
    for _ in range(20):
        first, second = (
            random.poisson(1.0, 17).astype(float),
            random.poisson(1.5, 11).astype(float),
        )
        expected = scipy.stats.mannwhitneyu(
            second, first, alternative='greater', use_continuity=False, method='asymptotic'
        )
        p_value, worse = van_elteren([(first, second)])
        assert p_value == pytest.approx(expected.pvalue, rel=1e-9)
        assert worse == pytest.approx(expected.statistic / (17 * 11))


SIZES = [[(30, 30)] * 11, [(3, 3)] * 11, [(12, 5), (7, 9), (20, 8)]]


@pytest.mark.parametrize(
    ('failing', 'sizes'), sampled(itertools.product([0.0, 0.2], SIZES), every=2)
)
def test_the_p_value_is_that_of_permutations_within_strata(
    sizes: list[tuple[int, int]], failing: float
) -> None:
    """Ranks and weights are computed here in another way; failures and counts are tied."""
    random = np.random.default_rng(7)
    for counted in (False, True):
        strata = []
        for n, m in sizes:
            values = random.poisson(0.7, n + m) if counted else random.normal(size=n + m)
            values = values + np.repeat([0.0, 0.15], [n, m])
            values = np.round(values) if counted else values
            strata.append(np.where(random.random(n + m) < failing, np.inf, values))
        observed, permuted = 0.0, np.zeros(20_000)
        for values, (n, m) in zip(strata, sizes, strict=True):
            ranks = scipy.stats.rankdata(values) / (n + m + 1)
            observed += ranks[n:].sum()
            shuffled = random.permuted(np.tile(ranks, (len(permuted), 1)), axis=1)
            permuted += shuffled[:, n:].sum(axis=1)
        # Half of the equal ones, as the normal distribution without a continuity correction has.
        equal = np.isclose(permuted, observed, atol=1e-9)
        expected = np.mean((permuted > observed) & ~equal) + np.mean(equal) / 2.0
        p_value, _ = van_elteren(
            [(each[:n], each[n:]) for each, (n, _) in zip(strata, sizes, strict=True)]
        )
        assert p_value == pytest.approx(expected, abs=0.012)


def test_strata_of_different_levels_do_not_hide_a_difference() -> None:
    """All values of a stratum are worse, by less than strata differ; together they look alike."""
    levels = np.repeat(np.arange(6) * 100.0, 8)
    random = np.random.default_rng(1)
    first, second = levels + random.uniform(size=48), levels + 1.0 + random.uniform(size=48)
    together = scipy.stats.mannwhitneyu(second, first, alternative='greater').pvalue
    p_value, worse = van_elteren(
        [(first[levels == each], second[levels == each]) for each in set(levels)]
    )
    assert together > 0.05
    assert p_value is not None
    assert p_value < 1e-9
    assert worse == 1.0


def test_strata_of_one_sample_alone_say_nothing_and_equal_values_no_gap() -> None:
    empty, ones = np.zeros(0), np.ones(4)
    assert van_elteren([(empty, ones), (ones, empty)]) == (None, None)
    assert van_elteren([(ones, ones), (empty, ones)]) == (1.0, 0.5)
    first, second = np.array([1.0, 2.0, 3.0]), np.array([2.0, 4.0])
    assert van_elteren([(first, second), (empty, ones)]) == van_elteren([(first, second)])


def gaps_in(
    development: CaseFigures, held_out: CaseFigures, scenarios: list[str]
) -> dict[str, bool]:
    """Return by name whether each figure differs."""
    found = gaps_of((development, scenarios), (held_out, scenarios))
    return {each.name: each.differs for each in found}


def test_only_what_is_worse_in_held_out_cases_is_a_gap() -> None:
    scenarios = ['launch'] * 10 + ['tip_in'] * 10
    random = np.random.default_rng(2)
    plain = CaseFigures(np.ones(20, bool), random.uniform(size=(5, 20)))
    values = random.uniform(size=(5, 20))
    values[1] += 1.0
    worse = CaseFigures(np.ones(20, bool), values)
    names = [each.name for each in FIGURES]
    expected = dict.fromkeys(names, False)
    assert gaps_in(plain, worse, scenarios) == {**expected, 'peak_jerk_m_s3': True}
    assert gaps_in(worse, plain, scenarios) == expected


def test_five_figures_share_the_level() -> None:
    scenarios, success = np.zeros(20), np.ones(20, bool)
    development = CaseFigures(success, np.zeros((5, 20)))
    found = []
    for larger in range(20):
        values = np.zeros((5, 20))
        values[0, :larger] = 1.0
        held_out = CaseFigures(success, values)
        found.append(gaps_of((development, scenarios), (held_out, scenarios))[0])
    p_values = [each.p_value or 0.0 for each in found]
    assert any(0.01 < each < 0.05 for each in p_values)
    assert [each.differs for each in found] == [each <= 0.01 for each in p_values]


def test_more_failures_are_a_gap_even_where_every_success_is_equal() -> None:
    success = np.arange(100) >= 12
    equal = np.ones((5, 100))
    found = gaps_of(
        (CaseFigures(np.ones(100, bool), equal), np.arange(100) % 4),
        (CaseFigures(success, np.where(success, equal, np.nan)), np.arange(100) % 4),
    )
    assert all(each.differs for each in found)
    assert [each.left_out for each in found] == [0] * 5
    assert found[0].worse == pytest.approx(0.56)


def test_successes_without_a_value_are_left_out_and_counted() -> None:
    values = np.ones((5, 10))
    values[0] = np.nan
    ours = CaseFigures(np.ones(10, bool), values)
    response, jerk, *_ = gaps_of((ours, np.zeros(10)), (ours, np.zeros(10)))
    assert (response.p_value, response.worse, response.differs) == (None, None, False)
    assert response.left_out == 20
    assert (jerk.p_value, jerk.worse, jerk.left_out) == (1.0, 0.5, 0)


def test_the_order_of_cases_and_scenarios_does_not_matter() -> None:
    made = MadeBenchmark(np.random.default_rng(6))
    development = made.run()
    made.draw_cases()
    held_out = made.run()
    order = np.random.default_rng(8).permutation(len(IN_SCENARIO))
    shuffled = CaseFigures(held_out.success[order], held_out.values[:, order])
    expected = gaps_of((development, IN_SCENARIO), (held_out, IN_SCENARIO))
    found = gaps_of((development, IN_SCENARIO), (shuffled, IN_SCENARIO[order]))
    assert found == expected


def test_a_memoriser_is_flagged_and_an_honest_controller_is_not() -> None:
    """A sample of the nightly test."""
    found = flagged_draws(40, seed=1, kinds=('honest', 'a tenth less jerk', 'no failures'))
    assert found['honest'] <= 4
    assert found['a tenth less jerk'] >= 36
    assert found['no failures'] >= 36
