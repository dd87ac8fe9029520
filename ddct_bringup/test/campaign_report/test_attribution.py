# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Attribution of failure to the keys that drive it, and to no others; none for few failures."""

import numpy as np
import pytest
from made_results import made_results

from ddct_bringup.campaign_report.statistics import attribution as attribution_module
from ddct_bringup.campaign_report.statistics.attribution import FEWEST, effects_of, too_few
from ddct_bringup.campaign_report.summary import summary_of
from ddct_bringup.verdict.state import ENGAGED, INVALID

KEYS = ('wear_gain', 'vehicle.mass_kg', 'actuator.delay_s', 'load.slope_rad', 'gear', 'noise')
RUNS = 400


def drawn(seed, runs=RUNS):
    """Return six keys that were drawn independently, one of them with five values."""
    random = np.random.default_rng(seed)
    values = {key: random.uniform(size=runs) for key in KEYS}
    return {**values, 'gear': random.integers(1, 6, runs).astype(float)}


def blamed(values, failed):
    return [each.key for each in effects_of(values, failed) if each.drives]


def attribution(values, failed, **invalid):
    states = np.where(failed, 'not_engaged', ENGAGED).astype(object)
    for row in invalid.get('rows', ()):
        states[row] = INVALID
    results = made_results(states.tolist(), values, random=list(values))
    return summary_of(results)['groups'][0]['attribution']


def test_failures_that_wear_alone_causes_are_attributed_to_wear_and_to_no_other_key():
    values = drawn(1)
    found = attribution(values, values['wear_gain'] < 0.1)
    first, *others = found['keys']
    assert (first['key'], first['drives']) == ('wear_gain', True)
    assert first['explained'] > 0.8
    assert first['interval'][0] > 0.5
    assert (first['worst_part']['failed'], first['worst_part']['runs']) == (40, 40)
    assert first['worst_part']['high'] < 0.11
    assert len(others) == len(KEYS) - 1
    assert not any(each['drives'] for each in others)
    assert all(each['interval'][0] == 0.0 for each in others)


def test_two_failed_runs_are_too_few():
    values = drawn(2)
    failed = np.zeros(RUNS, dtype=bool)
    failed[[3, 77]] = True
    found = attribution(values, failed)
    assert found['keys'] == []
    assert found['too_few'].startswith('2 of 400 valid runs failed: too few to say')


@pytest.mark.parametrize('failures', [FEWEST - 1, FEWEST])
def test_too_few_runs_that_did_not_fail_give_no_attribution(failures):
    failed = np.arange(RUNS) < failures
    assert bool(too_few(failed)) == bool(too_few(~failed)) == (failures < FEWEST)


def test_five_failures_in_one_corner_are_enough():
    values = drawn(3)
    failed = values['wear_gain'] <= np.sort(values['wear_gain'])[4]
    assert blamed(values, failed) == ['wear_gain']


def test_a_key_that_causes_failure_at_both_ends_is_found():
    values = drawn(4)
    wear = values['wear_gain']
    assert blamed(values, (wear < 0.08) | (wear > 0.92)) == ['wear_gain']


def test_a_key_of_few_values_is_found():
    values = drawn(5)
    assert blamed(values, (values['gear'] == 2.0)) == ['gear']


def test_two_keys_that_both_drive_failure_are_both_found():
    values = drawn(6)
    failed = (values['wear_gain'] < 0.12) | (values['load.slope_rad'] > 0.88)
    assert sorted(blamed(values, failed)) == ['load.slope_rad', 'wear_gain']


@pytest.mark.slow
def test_few_campaigns_attribute_failures_that_no_key_causes_to_a_key(monkeypatch):
    # The intervals, which take most of the time, are drawn after all p-values and not compared.
    monkeypatch.setattr(attribution_module, '_RESAMPLES', 1)
    wrong = 0
    for seed in range(200):
        failed = np.random.default_rng([1, seed]).random(RUNS) < 0.1
        wrong += bool(blamed(drawn(seed), failed))
    assert wrong <= 18  # 5 % of 200 are 10; more than 18 come by chance in 0.7 % of the cases


@pytest.mark.slow
def test_the_interval_covers_the_main_effect():
    slope, mean = 0.4, 0.2
    true = slope**2 / 12 / (mean * (1 - mean))  # failure has the chance 0.4 (1 - wear)
    covered = 0
    for seed in range(100):
        values = drawn(seed)['wear_gain']
        failed = np.random.default_rng([2, seed]).random(RUNS) < slope * (1.0 - values)
        (wear,) = effects_of({'wear_gain': values}, failed)
        covered += wear.interval[0] <= true <= wear.interval[1]
    assert covered >= 86


def test_invalid_runs_take_no_part():
    values = drawn(7)
    found = attribution(values, values['wear_gain'] < 0.1, rows=range(50))
    assert found['runs'] == 350
    assert found['keys'][0]['key'] == 'wear_gain'


def test_the_same_runs_give_the_same_effects():
    values = drawn(8)
    failed = values['wear_gain'] < 0.2
    assert effects_of(values, failed) == effects_of(values, failed)


def test_a_grid_has_no_attribution():
    results = made_results([ENGAGED, 'stalled'], {'wear_gain': [1.0, 0.8]})
    assert summary_of(results)['groups'][0]['attribution'] is None
