# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Values of `--over`, and how each invalid value is refused."""

import pytest

from ddct_bringup.sweep.axis import axis, axis_of, value_text
from ddct_plant.base.errors import ParameterError


def test_a_range_has_both_ends_and_values_that_print_as_they_run():
    wear = axis_of('wear_gain=0.5:1.5:11')
    assert wear.values == (0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5)
    assert [float(value_text(value)) for value in axis_of('wear_gain=0:1:7').values] == list(
        axis_of('wear_gain=0:1:7').values
    )


def test_a_range_may_fall_and_a_count_of_one_is_the_start():
    assert axis_of('load.slope_rad=0.1:-0.1:3').values == (0.1, 0.0, -0.1)
    assert axis_of('load.slope_rad=0.1:0.2:1').values == (0.1,)


def test_values_have_the_kind_and_the_unit_of_their_key():
    mass, gear = axis_of('vehicle.mass_kg=1000:2000:3'), axis_of('gear=1:5:3')
    assert (mass.values, mass.unit, mass.heading) == (
        (1000.0, 1500.0, 2000.0),
        'kg',
        'vehicle.mass_kg, kg',
    )
    assert all(type(value) is float for value in mass.values)
    assert gear.values == (1, 3, 5)
    assert all(type(value) is int for value in gear.values)
    assert axis('controllers.pi.integral_gain', [0.1]).unit == 'N m/(rpm s)'


def test_a_list_has_numbers_or_text():
    assert axis_of('wear_gain=1,0.7').values == (1.0, 0.7)
    words = axis_of('architecture=base,detailed')
    assert (words.values, words.numeric) == (('base', 'detailed'), False)


BAD = {
    'no values': ('wear_gain', 'KEY=START:STOP:COUNT'),
    'empty': ('wear_gain=', 'KEY=START:STOP:COUNT'),
    'no key': ('=1:2:3', 'KEY=START:STOP:COUNT'),
    'symbol of the thesis': ('K_usura=1:2:3', 'unknown key K_usura: did you mean wear_gain?'),
    'unknown key': ('wear_gian=1:2:3', 'did you mean wear_gain'),
    'two of three': ('wear_gain=1:2', 'KEY=START:STOP:COUNT'),
    'four of three': ('wear_gain=1:2:3:4', 'KEY=START:STOP:COUNT'),
    'a word in a range': ('wear_gain=low:2:3', 'KEY=START:STOP:COUNT'),
    'no end': ('wear_gain=1:inf:3', 'KEY=START:STOP:COUNT'),
    'half a count': ('wear_gain=1:2:2.5', 'KEY=START:STOP:COUNT'),
    'count of none': ('wear_gain=1:2:0', 'COUNT is 0: give 1 to 10000'),
    'negative count': ('wear_gain=1:2:-3', 'COUNT is -3: give 1 to 10000'),
    'too many': ('wear_gain=1:2:10001', 'COUNT is 10001: give 1 to 10000'),
    'no range': ('wear_gain=1:1:4', 'START and STOP are the same'),
    'one twice': ('wear_gain=1,0.7,1.0', '1.0 is there twice'),
    'not finite': ('wear_gain=nan,1', 'nan is not finite'),
    'nothing between': ('wear_gain=1,,2', 'no single value'),
}


@pytest.mark.parametrize(('text', 'words'), BAD.values(), ids=BAD)
def test_keys_that_cannot_be_varied_are_refused_with_advice(text, words):
    with pytest.raises(ParameterError, match='--over') as error:
        axis_of(text)
    assert words in str(error.value)
    assert '\n' not in str(error.value)
