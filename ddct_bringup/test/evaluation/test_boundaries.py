# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Boundary of failure on a grid: along one line, from its start to both sides."""

import numpy as np
import pytest
from made_results import made_results

from ddct_bringup.campaign_report.texts import boundary_text, good_text
from ddct_bringup.evaluation.boundaries import BoundarySide, boundary_sides
from ddct_bringup.evaluation.share import Share
from ddct_bringup.evaluation.summarise import summary_of
from ddct_bringup.verdict.state import ENGAGED, INVALID
from ddct_plant.files.json_records import to_json

WEAR = [0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3]


def found(outcomes, start=1.0, values=WEAR):
    outcomes = np.array(outcomes, dtype=object)
    index = np.arange(len(outcomes))
    sides = boundary_sides(np.array(values), outcomes, start, index, outcomes)
    return dict(zip(('below', 'above'), sides, strict=True))


def side_of(last_good, first_failure, row=None, failed=None, invalid=0):
    """Return a side whose first failed run, if any, is in a row."""
    state = None if row is None else 'failed'
    return BoundarySide(last_good, first_failure, failed, invalid, row, state)


def by_mark(marks):
    """Return outcomes from a row of letters."""
    return [{'e': ENGAGED, 'f': 'failed', 'i': INVALID}[mark] for mark in marks]


def test_the_first_failure_is_the_one_next_to_the_last_good_and_not_the_last():
    sides = found(by_mark('efeeeeff'))
    assert sides['below'] == side_of(0.8, 0.7, 1, Share(1, 1))
    assert sides['above'] == side_of(1.1, 1.2, 6, Share(1, 1))


def test_without_a_failure_all_is_good_to_the_ends_of_the_range():
    sides = found(by_mark('eeeeeeee'))
    assert (sides['below'].last_good, sides['below'].first_failure) == (0.6, None)
    assert (sides['above'].last_good, sides['above'].first_failure) == (1.3, None)


def test_a_start_that_fails_is_the_first_failure_of_both_sides_and_no_value_is_good():
    sides = found(by_mark('eeeefeee'))
    assert sides['below'] == sides['above'] == side_of(None, 1.0, 4, Share(1, 1))


def test_a_run_that_does_not_count_is_no_failure_and_no_good_value():
    above = found(by_mark('eeeeeief'))['above']
    assert above == side_of(1.0, 1.3, 7, Share(1, 1), invalid=1)
    assert found(by_mark('eeeeeiee'))['above'] == side_of(1.0, None, invalid=1)


def test_a_value_with_several_runs_fails_with_one_of_them():
    sides = found(by_mark('eeeif'), 1.0, [1.0, 1.0, 1.0, 1.1, 1.1])
    assert sides['above'] == side_of(1.0, 1.1, 4, Share(1, 2), invalid=1)


def test_one_run_is_enough():
    assert found([ENGAGED], values=[1.0])['below'] == side_of(1.0, None)


@pytest.mark.parametrize('seed', range(20))
def test_the_last_good_and_the_first_failure_are_never_the_same(seed):
    random = np.random.default_rng(seed)
    marks = random.choice(list('eeefi'), size=24)
    values = np.repeat(WEAR, 3)
    for side in found(by_mark(marks), 1.0, values).values():
        assert side.last_good is None or side.last_good != side.first_failure


@pytest.mark.parametrize(('good', 'bad'), [(1500.1, 1500.2), (0.1234561, 0.1234562), (0.9, 0.8)])
def test_their_texts_have_enough_digits_to_differ(good, bad):
    side = BoundarySide(
        last_good=good,
        first_failure=bad,
        failed=Share(1, 1),
        invalid=0,
        index=3,
        state='stalled',
    )
    assert float(boundary_text(side).split()[0]) == bad
    assert good_text(side) == f'good to {good}'


def summary_over_wear_and_mass(states):
    wear, mass = [0.8, 0.9, 1.0] * 3, [1000.0] * 3 + [1400.0] * 3 + [1800.0] * 3
    varied = {'wear_gain': wear, 'vehicle.mass_kg': mass}
    nominal = {'wear_gain': 1.0, 'vehicle.mass_kg': 1500.0}
    return to_json(summary_of(made_results(states, varied, nominal=nominal)))['groups'][0]


def test_on_a_grid_the_others_are_at_the_value_nearest_to_nominal():
    states = [ENGAGED] * 9
    states[0] = 'stalled'  # wear 0.8 at 1000 kg, on no line
    states[4] = 'withheld'  # wear 0.9 at 1400 kg
    states[8] = 'not_engaged'  # 1800 kg at wear 1
    wear, mass = summary_over_wear_and_mass(states)['boundaries']
    assert (wear['start'], wear['others']) == (1.0, {'vehicle.mass_kg': 1400.0})
    assert wear['below'] == {
        'last_good': 1.0,
        'first_failure': 0.9,
        'failed': {'count': 1, 'of': 1, 'low': None, 'high': None},
        'invalid': 0,
        'index': 4,
        'state': 'withheld',
    }
    assert wear['above']['first_failure'] is None
    assert (mass['nominal'], mass['start']) == (1500.0, 1400.0)
    assert (mass['above']['first_failure'], mass['above']['last_good']) == (1800.0, 1400.0)
    assert (mass['below']['first_failure'], mass['below']['last_good']) == (None, 1000.0)


def test_random_samples_have_no_boundary():
    wear = [0.95, 0.8, 1.2]
    states = [ENGAGED, 'stalled', ENGAGED]
    results = made_results(states, {'wear_gain': wear}, random=['wear_gain'])
    (group,) = to_json(summary_of(results))['groups']
    assert group['boundaries'] == []
    mixed = made_results(
        states, {'gear': [1.0, 2.0, 2.0], 'wear_gain': wear}, random=['wear_gain']
    )
    assert to_json(summary_of(mixed))['groups'][0]['boundaries'] == []


def test_a_number_that_the_scenario_has_not_starts_at_the_value_nearest_to_zero():
    results = made_results([ENGAGED, 'withheld'], {'sensors.delay_s': [0.01, 0.02]})
    (delay,) = to_json(summary_of(results))['groups'][0]['boundaries']
    assert (delay['nominal'], delay['start']) == (None, 0.01)
    assert delay['above']['first_failure'] == 0.02


def test_a_seed_is_no_number_that_failure_begins_at():
    varied = {'seed': [1, 2, 1, 2], 'wear_gain': [0.8, 0.8, 1.0, 1.0]}
    states = [ENGAGED, 'stalled', ENGAGED, ENGAGED]
    found = to_json(
        summary_of(made_results(states, varied, nominal={'seed': 0.0, 'wear_gain': 1.0}))
    )
    (wear,) = found['groups'][0]['boundaries']
    assert wear['key'] == 'wear_gain'
    assert (wear['below']['failed']['count'], wear['below']['failed']['of']) == (1, 2)
