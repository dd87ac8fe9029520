"""How bad a quantity becomes: median, CVaR and worst case, and what failed runs do to them."""

import numpy as np
import pytest
from made_results import made_results

from ddct_bringup.campaign_report.outcome import conditional_value_at_risk, tail_of
from ddct_bringup.campaign_report.summary import summary_of
from ddct_bringup.verdict.state import ENGAGED, INVALID


def engaged(count):
    return np.array([ENGAGED] * count, dtype=object)


@pytest.mark.parametrize(
    ('runs', 'wanted'),
    [
        (100, (96 + 97 + 98 + 99 + 100) / 5),
        (30, (30 + 29 / 2) / 1.5),
        (20, 20.0),
        (7, 7.0),
        (1, 1.0),
    ],
)
def test_cvar_is_the_mean_of_the_worst_twentieth(runs, wanted):
    values = np.random.default_rng(1).permutation(np.arange(1.0, runs + 1.0))
    assert conditional_value_at_risk(values) == pytest.approx(wanted, rel=1e-14)


@pytest.mark.parametrize('runs', [1, 19, 20, 21, 133, 1000])
def test_cvar_is_the_minimum_that_rockafellar_and_uryasev_define_it_by(runs):
    values = np.random.default_rng(runs).lognormal(size=runs)
    minima = [level + np.maximum(values - level, 0.0).mean() / 0.05 for level in values]
    assert conditional_value_at_risk(values) == pytest.approx(min(minima), rel=1e-12)


@pytest.mark.parametrize('outcome', ['failed', INVALID])
@pytest.mark.parametrize('runs', [1, 5, 40, 41])
def test_a_run_that_fails_or_is_invalid_never_makes_a_figure_better(outcome, runs):
    values = np.random.default_rng(runs).normal(size=runs)
    before = tail_of(values, engaged(runs))
    for place in range(runs):
        outcomes = engaged(runs)
        outcomes[place] = outcome
        after = tail_of(values, outcomes)
        assert after.cvar is None
        assert after.lacking == 1
        assert after.median is None or after.median >= before.median


def test_a_value_that_is_not_defined_ranks_behind_every_value_too():
    found = tail_of(np.array([1.0, 2.0, np.nan]), engaged(3))
    assert (found.with_value, found.median, found.cvar, found.lacking) == (2, 2.0, None, 1)


def test_failures_that_reach_the_middle_leave_no_median():
    outcomes = np.array([ENGAGED, 'failed'], dtype=object)
    assert tail_of(np.array([1.0, 2.0]), outcomes).median is None


def test_magnitudes_count_and_the_worst_case_keeps_its_sign():
    results = made_results(
        [ENGAGED, ENGAGED, 'runaway', 'invalid'],
        {'wear_gain': [0.8, 0.9, 1.0, 1.1]},
        {'slip_final_rpm': [3.0, -7.0, -50.0, 900.0]},
    )
    (found,) = summary_of(results)['groups'][0]['quantities']
    assert found['worst_engaged'] == {'value': -7.0, 'index': 1, 'state': ENGAGED}
    assert found['worst'] == {'value': -50.0, 'index': 2, 'state': 'runaway'}


def test_where_no_run_has_a_value_there_is_no_worst_case():
    found = tail_of(np.array([np.nan, 4.0]), np.array([ENGAGED, INVALID], dtype=object))
    assert (found.worst_engaged, found.worst, found.cvar, found.with_value) == (
        None,
        None,
        None,
        0,
    )


def test_of_equals_the_first_is_the_worst_case():
    assert tail_of(np.array([1.0, 5.0, 5.0]), engaged(3)).worst == 1
