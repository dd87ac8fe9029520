# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Distribution of a quantity over engaged runs, and its worst case; failures are not ranked."""

import numpy as np
import pytest
from made_results import made_results

from ddct_bringup.evaluation.spread import (
    Quantiles,
    conditional_value_at_risk,
)
from ddct_bringup.evaluation.spread import (
    spread_of as summarised_spread,
)
from ddct_bringup.evaluation.summarise import summary_of
from ddct_bringup.verdict.state import ENGAGED, INVALID
from ddct_plant.files.json_records import to_json


def spread_of(values, outcomes):
    """Return the statistics of runs whose index is their place."""
    return summarised_spread('s', values, outcomes, np.arange(len(values)), outcomes)


def worst_of(found):
    """Return the indices of the worst engaged and the worst valid run."""
    return [each and each.index for each in (found.worst_engaged, found.worst)]


def engaged(count):
    return np.array([ENGAGED] * count, dtype=object)


@pytest.mark.parametrize(
    ('runs', 'wanted'),
    [(100, (96 + 97 + 98 + 99 + 100) / 5), (30, (30 + 29 / 2) / 1.5), (20, 20.0)],
)
def test_cvar_is_the_mean_of_the_worst_twentieth(runs, wanted):
    values = np.random.default_rng(1).permutation(np.arange(1.0, runs + 1.0))
    assert conditional_value_at_risk(values) == pytest.approx(wanted, rel=1e-14)


@pytest.mark.parametrize('runs', [20, 21, 133, 1000])
def test_cvar_is_the_minimum_that_rockafellar_and_uryasev_define_it_by(runs):
    values = np.random.default_rng(runs).lognormal(size=runs)
    minima = [level + np.maximum(values - level, 0.0).mean() / 0.05 for level in values]
    assert conditional_value_at_risk(values) == pytest.approx(min(minima), rel=1e-12)


@pytest.mark.parametrize('outcome', ['failed', INVALID])
def test_a_run_that_is_not_engaged_has_no_place_among_the_quantiles(outcome):
    values = np.concatenate([np.arange(1.0, 102.0), [1e6] * 30, [0.0] * 30])
    outcomes = np.array([ENGAGED] * 101 + [outcome] * 60, dtype=object)
    found = spread_of(values, outcomes)
    assert found.quantiles == Quantiles(6.0, 51.0, 96.0)
    assert found.cvar_engaged == pytest.approx(conditional_value_at_risk(values[:101]))
    assert (found.with_value, worst_of(found)[0]) == (101, 100)


def test_half_of_the_runs_failed_and_the_median_is_still_that_of_the_engaged_ones():
    states = [ENGAGED] * 3 + ['not_engaged'] * 5
    results = made_results(
        states, {'wear_gain': list(range(8))}, {'peak_jerk_m_s3': [4.0, 6.0, 5.0, *[90.0] * 5]}
    )
    (group,) = summary_of(results).groups
    (found,) = group.quantities.values()
    assert (found.quantiles.p50, group.engaged.count, found.with_value) == (5.0, 3, 3)


def test_fewer_than_twenty_engaged_runs_have_no_cvar():
    values = np.arange(25.0)
    outcomes = np.array([ENGAGED] * 19 + ['failed'] * 6, dtype=object)
    assert spread_of(values, outcomes).cvar_engaged is None
    outcomes[19] = ENGAGED
    assert spread_of(values, outcomes).cvar_engaged == 19.0


def test_a_value_that_is_not_defined_is_counted_and_left_out():
    found = spread_of(np.array([1.0, 2.0, np.nan]), engaged(3))
    assert (found.with_value, found.quantiles.p50) == (2, 1.5)


def test_without_an_engaged_run_there_are_no_quantiles():
    found = spread_of(np.array([1.0]), np.array(['failed'], dtype=object))
    assert found.quantiles == Quantiles(None, None, None)
    assert worst_of(found) == [None, 0]


def test_quantiles_keep_their_signs_and_the_worst_case_is_the_largest_magnitude_with_its_sign():
    slips = [*np.linspace(-236.88, 60.0, 21).tolist(), -500.0, 900.0]
    states = [ENGAGED] * 21 + ['withheld', INVALID]
    wear = {'wear_gain': list(range(23))}
    results = made_results(states, wear, {'slip_final_rpm': slips})
    found = to_json(summary_of(results))['groups'][0]['quantities']['slip_final_rpm']
    assert found['p5'] < found['p50'] < 0.0 < found['p95']
    assert found['worst_engaged'] == {'value': -236.88, 'index': 0, 'state': ENGAGED}
    assert found['worst'] == {'value': -500.0, 'index': 21, 'state': 'withheld'}
    assert found['cvar_engaged'] > 0.0


def test_where_no_run_has_a_value_there_is_no_worst_case():
    found = spread_of(np.array([np.nan, 4.0]), np.array([ENGAGED, INVALID], dtype=object))
    assert (found.worst_engaged, found.worst, found.cvar_engaged, found.with_value) == (
        None,
        None,
        None,
        0,
    )


def test_of_equals_the_first_is_the_worst_case():
    assert worst_of(spread_of(np.array([1.0, 5.0, 5.0]), engaged(3))) == [1, 1]
