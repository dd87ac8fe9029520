# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rules of the thesis gate: required parts of a claim, and when it fails."""

import dataclasses

import pytest
from refusals import refused

from ddct_bringup.reproduction.numbers.command import compute
from ddct_bringup.reproduction.numbers.gate import judge
from ddct_bringup.reproduction.numbers.gate_tables import computed_text, page_tables
from ddct_bringup.reproduction.numbers.number_files import parse_numbers
from ddct_bringup.reproduction.numbers.thesis_number import Finding, ThesisNumber, Tolerance
from ddct_plant.base.errors import ParameterError

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
GIVEN = dataclasses.replace(REPRODUCED, verdict='given', id=None, tolerance=None)
PREDICTED = dataclasses.replace(REPRODUCED, verdict='predicted')
CALIBRATED = dataclasses.replace(REPRODUCED, verdict='calibrated')
TEXT = dataclasses.replace(REPRODUCED, printed='negative', tolerance=None)


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


def test_a_number_less_than_two_tolerances_off_is_a_miss_and_no_erratum():
    near = dataclasses.replace(ERRATUM, ours='0.536', tolerance=Tolerance(absolute=0.005))
    assert 'less than 2 tolerances from the printed 0.53: a miss' in complaint(near, 0.536)
    assert complaint(dataclasses.replace(near, ours='0.541'), 0.541) is None


def test_texts_must_be_equal():
    assert complaint(TEXT, 'negative') is None
    assert complaint(TEXT, 'positive')


@pytest.mark.parametrize(('value', 'hit'), [(0.532, True), (0.54, False)])
def test_prediction_is_a_hit_or_a_miss_and_both_hold(value, hit):
    (row,) = judge([PREDICTED], {'zeta': value})
    assert row.complaint is None and row.hit is hit
    assert row.outcome == ('predicted hit' if hit else 'predicted miss')


def test_prediction_without_a_value_does_not_hold():
    assert complaint(PREDICTED, None)


def test_miss_of_a_fit_holds_only_where_the_list_states_it():
    missed = dataclasses.replace(CALIBRATED, hit='no')
    assert 'not within' in complaint(CALIBRATED, 0.54)
    assert complaint(missed, 0.54) is None
    assert '0.53 is within the tolerance' in complaint(missed, 0.53)


@pytest.mark.parametrize('holds', [True, False])
def test_qualitative_claim_holds_by_its_finding_and_shows_its_evidence(holds):
    (row,) = judge(
        [dataclasses.replace(PREDICTED, printed='larger', tolerance=None)],
        {'zeta': Finding(holds, '1.2 rpm')},
    )
    assert row.hit is holds and row.complaint is None
    assert row.entry.computed == computed_text(row) == '1.2 rpm'


def test_number_without_a_tolerance_is_refused_unless_it_is_found_to_hold():
    number = dataclasses.replace(REPRODUCED, tolerance=None)
    assert complaint(number, 0.53) == 'a computed number needs a tolerance'
    assert complaint(number, Finding(True, 'at least 0.5')) is None


def test_given_number_has_no_computed_value_and_always_holds():
    (row,) = judge([GIVEN], {})
    assert row.computed is None and row.complaint is None and row.hit is None
    assert row.entry.tolerance is None and row.entry.group == '2.2, zeta'


def test_computed_value_without_an_entry_in_the_list_is_refused():
    with refused(ParameterError, 'other'):
        judge([REPRODUCED], {'zeta': 0.53, 'other': 1.0})


@pytest.mark.parametrize(
    ('change', 'complaint_text'),
    [
        ({'verdict': 'likely'}, "unknown verdict 'likely'"),
        ({'id': None}, 'verdict reproduced needs id'),
        ({'printed': 'negative'}, 'a word, and what nothing computes, has no tolerance'),
        ({'verdict': 'given', 'id': None}, 'a word, and what nothing computes, has no tolerance'),
        ({'verdict': 'not_reproducible'}, 'verdict not_reproducible has no id'),
        ({'verdict': 'erratum'}, 'give `ours` with an erratum'),
        ({'ours': '0.6'}, 'not otherwise'),
        ({'hit': 'no'}, "`hit: 'no'` is for a calibrated number"),
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


@pytest.mark.parametrize(
    ('printed', 'half'), [('-1', 5e-4), ('0.948', 5e-5), ('-1.208', 5e-4), ('0.02714', 5e-6)]
)
def test_rounding_to_a_significant_digit_counts_zeros_that_the_print_drops(printed, half):
    assert Tolerance(significant=4).around(printed) == pytest.approx(half)


@pytest.mark.parametrize('parts', [{}, {'absolute': -1.0}])
def test_tolerance_without_a_positive_part_is_refused(parts):
    with pytest.raises(ParameterError, match='tolerance'):
        Tolerance(**parts)


LIST = """
- section: '3.2'
  verdict: 'given'
  reason: 'given'
  numbers:
  - {item: 'b', printed: '2'}
  - {item: 'a', printed: '1', unit: 's', section: '2.10'}
  - {item: 'c', printed: '3', section: '2.9, Table 1'}
"""


def test_entries_take_the_defaults_of_their_group_and_are_in_the_order_of_the_sections():
    numbers = parse_numbers(LIST)
    assert [number.item for number in numbers] == ['c', 'a', 'b']
    assert (numbers[1].unit, numbers[2].unit, numbers[2].reason) == ('s', '1', 'given')


@pytest.mark.parametrize(
    ('old', 'new', 'complaint_text'),
    [
        ("item: 'a'", "item: 'b', section: '3.2'", 'given twice: 3.2, b'),
        ("printed: '1'", 'printed: 1', 'printed is 1: put it in quotes'),
        ("unit: 's'", "units: 's'", 'unknown key units'),
        ("unit: 's'", "numbers: [{item: 'd', printed: '4'}]", 'unknown key numbers'),
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
    with refused(ParameterError, 'zeta'):
        compute({'first': lambda: {'zeta': 1.0}, 'second': lambda: {'zeta': 2.0}})


def test_computed_value_is_shown_with_one_digit_more_than_is_printed():
    (row,) = judge([REPRODUCED], {'zeta': 0.53051})
    assert computed_text(row) == '0.531'


def test_page_has_every_number_in_the_table_of_its_chapter_and_errata_twice():
    rows = judge([REPRODUCED, dataclasses.replace(ERRATUM, item='other')], {'zeta': 0.612})
    tables = page_tables(rows)
    assert [cells[1] for cells in tables['chapter_2'].rows] == ['zeta', 'other']
    assert [cells[1] for cells in tables['errata'].rows] == ['other']
    summary = {row[0]: row[-1] for row in tables['summary'].rows}
    assert (summary['reproduced'], summary['erratum'], summary['given']) == ('1', '1', '0')
