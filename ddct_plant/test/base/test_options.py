# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""An option is described once; its check, its text and its row follow from that."""

import math
from dataclasses import dataclass

import pytest
from refusals import refused

from ddct_plant.base.errors import ParameterError
from ddct_plant.base.option import option_rows
from ddct_plant.base.options import (
    REQUIRED,
    Option,
    OptionGroup,
    close_name,
    option,
    options_of,
    with_values,
)


@dataclass(frozen=True)
class Tyre(OptionGroup, prefix='tyre.'):
    make: str = option(REQUIRED, 'who made it', choices=('here', 'there'), kind=str)
    pressure_bar: float = option(2.2, 'cold', 'bar', source='assumed', above=0.0, at_most=9.0)
    layers: int = option(2, 'of the carcass', at_least=1)
    spare: bool = option(False, 'whether one is carried')
    wear_mm: tuple[float, ...] = option((), 'at its grooves', 'mm', many=True, at_least=0.0)
    changed_s: tuple[float, ...] = option((), '', 's', many=True, rising=True, whole_periods=True)


@pytest.mark.parametrize(
    ('changes', 'complaint'),
    [
        ({'pressure_bar': 0.0}, 'tyre.pressure_bar is 0 bar: it must be above 0'),
        ({'pressure_bar': 9.5}, 'tyre.pressure_bar is 9.5 bar: it must be at most 9'),
        ({'pressure_bar': math.nan}, 'tyre.pressure_bar is nan: give a finite number in bar'),
        ({'pressure_bar': '2'}, "tyre.pressure_bar is '2': give a number in bar"),
        ({'pressure_bar': True}, 'tyre.pressure_bar is True: give a number in bar'),
        ({'pressure_bar': None}, 'tyre.pressure_bar is empty: give a value'),
        ({'layers': 0}, 'tyre.layers is 0: it must be at least 1'),
        ({'layers': 1.5}, 'tyre.layers is 1.5: give a whole number'),
        ({'spare': 1}, 'tyre.spare is 1: give true or false'),
        (
            {'make': 'nowhere'},
            "unknown tyre.make 'nowhere': did you mean here? Else choose from here, there",
        ),
        ({'make': 5}, 'tyre.make is 5: give text'),
        ({'wear_mm': 1.0}, 'tyre.wear_mm is 1.0: give a list, [...]'),
        ({'wear_mm': (1.0, -2.0)}, 'tyre.wear_mm[1] is -2 mm: it must be at least 0'),
        ({'changed_s': (1.0, 1.0)}, 'tyre.changed_s goes from 1 to 1: it must rise'),
        ({'changed_s': (0.005,)}, 'tyre.changed_s[0] is 0.005 s: give a multiple of 0.01 s'),
    ],
)
def test_a_group_refuses_each_mistake_with_one_sentence(changes, complaint):
    with pytest.raises(ParameterError) as caught:
        Tyre(**{'make': 'here', **changes})
    assert str(caught.value) == complaint


def test_values_within_their_ranges_are_kept_as_they_are_given():
    tyre = Tyre(make='there', pressure_bar=9, layers=3, wear_mm=(0.0, 1.0), changed_s=(0.0, 0.01))
    assert (tyre.pressure_bar, type(tyre.pressure_bar)) == (9, int)
    assert tyre == Tyre('there', 9, 3, False, (0.0, 1.0), (0.0, 0.01))


def test_a_field_without_default_must_be_given():
    with pytest.raises(TypeError, match='make'):
        Tyre()


@dataclass(frozen=True)
class Load(OptionGroup):
    mass_kg: float | None = option(None, 'of what is carried', 'kg', at_least=0.0)
    wheels: int = 4


def test_an_option_without_default_may_be_left_out_and_is_checked_when_given():
    assert Load().mass_kg is None
    with refused(ParameterError, 'mass_kg'):
        Load(-1.0)


def test_a_group_describes_its_own_values_as_the_defaults():
    assert options_of(Tyre)['pressure_bar'].default == 2.2
    assert Tyre('here', 3.0).options['pressure_bar'].default == 3.0
    assert Tyre('here', 3.0).options['make'].default == 'here'
    assert list(Load().options) == ['mass_kg']


def test_a_group_takes_the_values_of_its_options_and_no_others():
    taken = with_values(Load(2.0, wheels=2), {'mass_kg': 5.0, 'wheels': 9, 'make': 'here'})
    assert taken == Load(5.0, wheels=2)
    assert with_values(taken, {}) == taken
    with refused(ParameterError, 'mass_kg'):
        with_values(taken, {'mass_kg': -1.0})


@pytest.mark.parametrize(
    ('described', 'value', 'taken'),
    [
        (Option(1.0, ''), 2, 2.0),
        (Option(1, ''), 2.0, 2),
        (Option(None, '', kind=int), 7, 7),
        (Option((), '', many=True), [1, 2], (1.0, 2.0)),
        (Option('a', ''), 'b', 'b'),
    ],
)
def test_a_checked_value_is_of_the_options_kind(described, value, taken):
    checked = described.checked('x', value)
    assert checked == taken
    assert type(checked) is type(taken)


def test_the_rows_have_all_that_is_declared():
    assert option_rows(options_of(Tyre), Tyre.prefix) == [
        ('tyre.make', '', 'required', 'here, there', 'who made it', ''),
        ('tyre.pressure_bar', 'bar', '2.2', 'above 0, at most 9', 'cold', 'assumed'),
        ('tyre.layers', '', '2', 'at least 1', 'of the carcass', ''),
        ('tyre.spare', '', 'false', 'true, false', 'whether one is carried', ''),
        ('tyre.wear_mm', 'mm', 'none', 'at least 0', 'at its grooves', ''),
        ('tyre.changed_s', 's', 'none', '', '', ''),
    ]
    described = Option(1.0, 'speed', 'm/s', at_least=0.0, at_most=2.0).description
    assert described == 'speed [m/s] (0 to 2)'


def test_a_name_that_was_nearly_right_is_suggested():
    assert close_name('spair', options_of(Tyre), Tyre.prefix) == 'did you mean tyre.spare?'
    assert close_name('x', ['one', 'two']) == 'known: one, two'
