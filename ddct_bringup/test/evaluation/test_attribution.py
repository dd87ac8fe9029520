# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Attribution of failure to the keys that drive it, and to no others; none for few failures."""

from itertools import combinations

import numpy as np
import pytest
from made_failures import KEYS, NAMES, RUNS, blamed, covered_effects, drawn, wrongly_blamed
from made_results import made_results

from ddct_bringup.campaign_report.texts import p_text
from ddct_bringup.evaluation import attribution as attribution_module
from ddct_bringup.evaluation.attribution import FEWEST, effects_of, too_few
from ddct_bringup.evaluation.parts import KeyPart, parts_of, worst_of
from ddct_bringup.evaluation.share import Share
from ddct_bringup.evaluation.summarise import summary_of
from ddct_bringup.verdict.state import ENGAGED, INVALID
from ddct_plant.files.json_records import to_json

pytestmark = pytest.mark.slow


def attribution(values, failed, **invalid):
    states = np.where(failed, 'not_engaged', ENGAGED).astype(object)
    for row in invalid.get('rows', ()):
        states[row] = INVALID
    results = made_results(states.tolist(), values, random=list(values))
    return to_json(summary_of(results))['groups'][0]['causes']


def test_failures_that_wear_alone_causes_are_attributed_to_wear_and_to_no_other_key():
    values = drawn(1)
    found = attribution(values, values['wear_gain'] < 0.1)
    first, *others = found['keys']
    assert (first['key'], first['drives']) == ('wear_gain', True)
    assert first['explained'] > 0.8
    assert first['interval'][0] > 0.5
    assert (first['worst_part']['failed']['count'], first['worst_part']['failed']['of']) == (
        40,
        40,
    )
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


def test_without_a_valid_run_nothing_is_counted():
    found = attribution(drawn(2), np.zeros(RUNS, dtype=bool), rows=range(RUNS))
    assert (found['keys'], found['too_few'][:12]) == ([], 'no valid run')


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


def test_few_campaigns_attribute_failures_that_no_key_causes_to_a_key(monkeypatch):
    """Of 200 campaigns at most 18 do: tests/nightly/campaign_report."""
    # The intervals, which take most of the time, are drawn after all p-values and not compared.
    monkeypatch.setattr(attribution_module, '_RESAMPLES', 1)
    assert wrongly_blamed(15) <= 3  # more come by chance in 0.5 % of the cases


def test_the_interval_covers_the_main_effect():
    assert covered_effects(20) >= 16


def test_invalid_runs_take_no_part():
    values = drawn(7)
    found = attribution(values, values['wear_gain'] < 0.1, rows=range(50))
    assert found['failed']['of'] == 350
    assert found['keys'][0]['key'] == 'wear_gain'


def test_the_same_runs_give_the_same_effects():
    values = drawn(8)
    failed = values['wear_gain'] < 0.2
    assert effects_of(values, failed) == effects_of(values, failed)


def of_names(failed_of):
    """Return names with their runs, and which of these fail: `failed_of` has (runs, failed)."""
    names = [name for name, (runs, _) in failed_of.items() for _ in range(runs)]
    failed = [place < count for runs, count in failed_of.values() for place in range(runs)]
    return np.array(names, dtype=object), np.array(failed)


def worst_names(failed_of):
    (effect,) = effects_of({'scenario': of_names(failed_of)[0]}, of_names(failed_of)[1])
    worst = effect.worst_part
    return worst.names, worst.failed.count, worst.failed.of


@pytest.mark.parametrize('order', [NAMES, NAMES[::-1], sorted(NAMES), NAMES[3:] + NAMES[:3]])
def test_the_names_that_fail_are_the_worst_group_in_any_order(order):
    fails = ('launch', 'upshift')
    found = worst_names({name: (3, 3 if name in fails else 0) for name in order})
    assert found == (tuple(name for name in order if name in fails), 6, 6)


def test_names_that_nearly_always_fail_are_one_group():
    counts = {'thesis': (30, 1), 'launch': (30, 29), 'tip_in': (30, 0), 'upshift': (30, 27)}
    assert worst_names(counts) == (('launch', 'upshift'), 56, 60)


def test_booleans_are_names():
    values = np.arange(RUNS) % 2 == 0
    (effect,) = effects_of({'cut': values}, values)
    assert effect.worst_part == KeyPart(Share(200, 200), names=('True',))


@pytest.mark.parametrize('seed', range(20))
def test_no_group_of_names_differs_more_from_the_others_than_the_worst(seed):
    random = np.random.default_rng([3, seed])
    counts = {name: (10, int(random.integers(0, 11))) for name in NAMES}
    values, failed = of_names(counts)

    def between(group):
        inside = np.isin(values, group)
        return (failed[inside].mean() - failed.mean()) ** 2 * inside.sum() / (~inside).sum()

    groups = [each for size in range(1, len(NAMES)) for each in combinations(NAMES, size)]
    worst = worst_of(parts_of(values, failed, 10))
    assert between(worst.names) == pytest.approx(max(map(between, groups)))
    assert failed[np.isin(values, worst.names)].mean() >= failed.mean()


def test_a_run_for_each_name_says_nothing_of_names():
    names = np.array([f'scenario_{number}' for number in range(20)], dtype=object)
    (effect,) = effects_of({'scenario': names}, np.arange(20) < 8)
    assert (effect.drives, effect.explained, effect.interval) == (False, 0.0, (0.0, 1.0))


def test_a_grid_has_no_attribution():
    results = made_results([ENGAGED, 'stalled'], {'wear_gain': [1.0, 0.8]})
    assert to_json(summary_of(results))['groups'][0]['causes'] is None


def test_a_p_value_below_its_last_digit_is_a_bound() -> None:
    assert [p_text(value) for value in (0.0009, 0.001, 0.25)] == ['< 0.001', '0.001', '0.250']
