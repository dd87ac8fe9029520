"""The rules of the thesis gate: what a claim needs, and when it does not hold."""

import dataclasses

import pytest

from ddct_controllers.design.thesis.gate import judge
from ddct_controllers.design.thesis.gate_tables import computed_text, page_tables
from ddct_controllers.design.thesis.number_file import parse_numbers
from ddct_controllers.design.thesis.sources import compute
from ddct_controllers.design.thesis.thesis_number import ThesisNumber, Tolerance
from ddct_plant.errors import ParameterError

REPRODUCED = ThesisNumber(
    section='2.2',
    item='zeta',
    printed='0.53',
    verdict='reproduced',
    reason='rounding',
    id='zeta',
    tolerance=Tolerance(half_units=1.0),
)
ERRATUM = dataclasses.replace(REPRODUCED, verdict='erratum', ours='0.61')
GIVEN = dataclasses.replace(REPRODUCED, verdict='not_reproducible', id=None, tolerance=None)
WORD = dataclasses.replace(REPRODUCED, printed='negative', tolerance=None)


def complaint(number: ThesisNumber, value) -> str | None:
    (row,) = judge([number], {'zeta': value})
    return row.complaint


@pytest.mark.parametrize('value', [0.525, 0.53, 0.535])
def test_reproduced_number_holds_to_half_a_unit_of_the_last_printed_digit(value):
    assert complaint(REPRODUCED, value) is None


@pytest.mark.parametrize('value', [0.524, 0.536, None, float('nan'), float('inf')])
def test_reproduced_number_does_not_hold_outside_or_without_a_value(value):
    assert complaint(REPRODUCED, value)


def test_number_that_no_source_computes_does_not_hold():
    (row,) = judge([REPRODUCED], {})
    assert row.complaint and row.complaint.startswith('nothing was computed for it')


def test_erratum_must_differ_from_the_print_and_be_the_value_given_as_ours():
    assert complaint(ERRATUM, 0.612) is None
    assert 'agrees with the print' in complaint(ERRATUM, 0.53)
    assert 'is not the 0.61' in complaint(ERRATUM, 0.64)


def test_words_must_be_equal():
    assert complaint(WORD, 'negative') is None
    assert complaint(WORD, 'positive')


def test_prediction_is_held_to_our_value_and_not_to_the_print():
    prediction = dataclasses.replace(ERRATUM, verdict='predicted')
    assert complaint(prediction, 0.612) is None
    assert complaint(prediction, 0.53)


def test_given_number_has_no_computed_value_and_always_holds():
    (row,) = judge([GIVEN], {})
    assert row.computed is None and row.complaint is None and row.as_dict()['tolerance'] is None


def test_computed_value_that_the_list_does_not_ask_for_is_refused():
    with pytest.raises(ParameterError, match='not in the list of numbers: other'):
        judge([REPRODUCED], {'zeta': 0.53, 'other': 1.0})


@pytest.mark.parametrize(
    ('change', 'complaint_text'),
    [
        ({'verdict': 'likely'}, "unknown verdict 'likely'"),
        ({'id': None}, 'verdict reproduced needs id'),
        ({'tolerance': None}, 'a computed number needs a tolerance'),
        ({'printed': 'negative'}, 'a word has none'),
        ({'verdict': 'not_reproducible'}, 'verdict not_reproducible has no id'),
        ({'verdict': 'erratum'}, 'give `ours` with an erratum'),
        ({'ours': '0.6'}, 'not otherwise'),
        ({'reason': ' '}, 'give a reason'),
    ],
)
def test_incomplete_claim_is_refused_by_name(change, complaint_text):
    with pytest.raises(ParameterError, match='2.2, zeta: ') as error:
        dataclasses.replace(REPRODUCED, **change)
    assert complaint_text in str(error.value)


def test_tolerance_is_the_widest_part():
    assert Tolerance(relative=0.08, absolute=0.02).around('0.16') == 0.02
    assert Tolerance(relative=0.08, absolute=0.02).around('-0.5') == pytest.approx(0.04)
    assert Tolerance(half_units=2.0).around('3.134e04') == pytest.approx(10.0)


@pytest.mark.parametrize('parts', [{}, {'absolute': -1.0}])
def test_tolerance_without_a_positive_part_is_refused(parts):
    with pytest.raises(ParameterError, match='tolerance'):
        Tolerance(**parts)


LIST = """
- section: '3.2'
  verdict: 'not_reproducible'
  reason: 'given'
  numbers:
  - {item: 'b', printed: '2'}
  - {item: 'a', printed: '1', unit: 's', section: '2.10'}
  - {item: 'c', printed: '3', section: '2.9, Table 1'}
"""


def test_entries_take_what_their_group_gives_and_stand_in_the_order_of_the_sections():
    numbers = parse_numbers(LIST)
    assert [number.item for number in numbers] == ['c', 'a', 'b']
    assert (numbers[1].unit, numbers[2].unit, numbers[2].reason) == ('s', '1', 'given')


@pytest.mark.parametrize(
    ('old', 'new', 'complaint_text'),
    [
        ("item: 'a'", "item: 'b', section: '3.2'", 'given twice: 3.2, b'),
        ("printed: '1'", 'printed: 1', 'printed is 1: put it in quotes'),
        ("unit: 's'", "units: 's'", 'unknown key units'),
        ("'2.10'", "'two'", "section 'two'"),
        ("item: 'b', ", '', 'item'),
    ],
)
def test_bad_entry_is_refused_by_name(old, new, complaint_text):
    text = LIST.replace(old, new)
    if 'section' in new:
        text = text.replace(", section: '2.10'", '')
    with pytest.raises(ParameterError) as error:
        parse_numbers(text)
    assert complaint_text in str(error.value)


def test_two_sources_may_not_compute_the_same_number():
    with pytest.raises(ParameterError, match='second: computed already: zeta'):
        compute({'first': lambda: {'zeta': 1.0}, 'second': lambda: {'zeta': 2.0}})


def test_computed_value_is_shown_with_one_digit_more_than_is_printed():
    (row,) = judge([REPRODUCED], {'zeta': 0.53051})
    assert computed_text(row) == '0.531'


def test_page_has_every_number_in_the_table_of_its_chapter_and_errata_twice():
    rows = judge([REPRODUCED, dataclasses.replace(ERRATUM, item='other')], {'zeta': 0.612})
    tables = page_tables(rows)
    assert [cells[1] for cells in tables['chapter_2'].rows] == ['zeta', 'other']
    assert [cells[1] for cells in tables['errata'].rows] == ['other']
    assert tables['summary'].rows[-1] == ('all', '1', '0', '0', '1', '0')
