# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The ratings of Table 5.2 and the orders behind qualitative claims."""

import math
from types import SimpleNamespace

import pytest

from ddct_bringup.reproduction.values import orders
from ddct_bringup.reproduction.values.orders import (
    below,
    each_lower,
    is_extreme,
    judge_ratings,
    ratings_of,
    sigma_text,
    text,
)

RATINGS = {'ls8': 'bad', 'hinf2': 'good', 'mpc3': 'bad', 'mpc4': 'average'}
SLIPS = {'ls8': 30.0, 'hinf2': 1.0, 'mpc3': 20.0, 'mpc4': 10.0}


def judged(**changed: float) -> dict[str, bool]:
    findings = judge_ratings(RATINGS, [('rad/s', {**SLIPS, **changed})])
    return {name: finding.holds for name, finding in findings.items()}


def test_ratings_hold_where_the_values_increase_with_them():
    assert all(judged().values())


def test_rating_in_the_wrong_order_to_another_misses_and_so_does_the_other():
    assert judged(mpc4=25.0) == {'ls8': True, 'hinf2': True, 'mpc3': False, 'mpc4': False}


@pytest.mark.parametrize(('slip', 'holds'), [(40.0, True), (40.1, False)])
def test_values_of_one_rating_are_at_most_twice_one_another(slip, holds):
    assert judged(ls8=slip)['mpc3'] is holds


def test_one_rating_for_four_spreads_that_differ_more_is_a_miss():
    spreads = {'ls8': 1.0, 'hinf2': 4.6, 'mpc3': 1.2, 'mpc4': 1.5}
    findings = judge_ratings(dict.fromkeys(spreads, 'average'), [('rpm', spreads)])
    assert not any(finding.holds for finding in findings.values())


def test_rating_of_two_quantities_must_be_right_in_both_and_shows_both():
    rows = [('rpm', SLIPS), ('m/s^2', {**SLIPS, 'mpc4': 50.0})]
    finding = judge_ratings(RATINGS, rows)['mpc4']
    assert not finding.holds and finding.evidence == '10 rpm, 50 m/s^2'


def test_value_that_does_not_exist_is_the_worst():
    assert not judged(mpc4=math.inf)['mpc4']
    figures = judge_ratings(RATINGS, [('rad/s', {**SLIPS, 'mpc4': math.inf})])['mpc4'].evidence
    assert figures == 'no figure'


ROW = {'pi': 4.0, 'ls8': 2.0, 'mpc4': 0.9}


@pytest.mark.parametrize(
    ('name', 'extreme', 'factor', 'holds'),
    [
        ('mpc4', min, 1.0, True),
        ('mpc4', min, 2.0, True),
        ('mpc4', min, 2.3, False),
        ('ls8', min, 1.0, False),
        ('pi', max, 1.9, True),
        ('pi', max, 2.0, False),
        ('ls8', max, 1.0, False),
    ],
)
def test_extreme_is_beyond_the_next_by_the_factor(name, extreme, factor, holds):
    assert is_extreme(name, extreme, [ROW], factor) is holds


def test_extreme_must_be_one_in_every_row_and_alone():
    assert not is_extreme('mpc4', min, [ROW, {**ROW, 'mpc4': 3.0}])
    assert not is_extreme('pi', max, [{**ROW, 'ls8': 4.0}])


def test_controller_without_a_value_is_not_lower():
    row = {**ROW, 'mpc4': math.inf}
    assert below('ls8', 'mpc4', [row]) and not below('mpc4', 'ls8', [row])
    assert text('s', row) == 'pi 4, ls8 2, mpc4 - s'


def test_each_lower_counts_those_that_are_lower_in_every_row():
    lower = {'pi': 3.0, 'ls8': 1.0, 'mpc4': 0.5}
    assert each_lower([lower], [ROW]).holds
    mixed = each_lower([lower, ROW], [ROW, ROW])
    assert not mixed.holds and mixed.evidence == '0 of 3 lower in both'
    assert each_lower([lower, ROW], [ROW, ROW], expected=False).holds
    assert not each_lower([lower], [ROW], expected=False).holds


def test_standard_deviations_are_shown_with_their_units():
    assert sigma_text((ROW, ROW), ('pi',)) == 'w_sr pi 4 rpm; A_x pi 4 m/s^2'


def test_value_that_does_not_exist_is_infinite(monkeypatch):
    none = SimpleNamespace(metrics={'engagement_time_s': None})
    monkeypatch.setattr(orders, 'thesis_run', lambda *arguments: none)
    assert orders.metric('engagement_time_s', ('mpc4',)) == {'mpc4': math.inf}


def test_values_within_twice_the_smallest_have_one_rating():
    row = {'a': 1.0, 'b': 2.0, 'c': 2.1, 'd': 9.0, 'e': math.inf}
    expected = {'a': 'good', 'b': 'good', 'c': 'average', 'd': 'average', 'e': 'bad'}
    assert ratings_of(row) == expected


def test_similar_values_have_no_different_ratings():
    assert set(ratings_of({'a': 0.0, 'b': 0.0}).values()) == {'alike'}
    assert ratings_of({'a': 0.0, 'b': 0.1}) == {'a': 'good', 'b': 'bad'}
