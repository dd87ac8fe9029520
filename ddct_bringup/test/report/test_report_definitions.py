# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page defines the terms of its tables and charts."""

from dataclasses import replace

import pytest

from ddct_bringup.documents.page_parts import unit_text
from ddct_bringup.metrics.catalogue import FIGURES, METRICS, OTHERS
from ddct_bringup.report.chart_signals import CHART_SIGNALS, CLUTCH_SIGNALS, SENSOR_SIGNALS
from ddct_bringup.report.definitions import ShownParts, definitions
from ddct_bringup.report.shift_signals import SHIFT_SIGNALS
from ddct_bringup.verdict.state import STATES
from ddct_controllers.design.analysis.loop_quantities import LOOP_QUANTITIES

SIGNALS = (*CHART_SIGNALS, *CLUTCH_SIGNALS, *SHIFT_SIGNALS, *SENSOR_SIGNALS)
ALL = ShownParts(
    SIGNALS,
    list(METRICS.values()),
    frozenset(state.replace('_', ' ') for state in STATES),
    frozenset({'lockstep', 'measured'}),
    thesis=True,
    shift=True,
    limits=True,
    beyond=True,
    yardstick=True,
    loops=True,
    times=True,
)
GROUPS = definitions(ALL)


@pytest.mark.parametrize(
    ('title', 'figures'),
    [
        ('Figures', [each for each in FIGURES if not each.of_shift]),
        ('Metrics', [each for each in OTHERS if not each.of_shift]),
        ('Gear shift', [each for each in METRICS.values() if each.of_shift]),
        ('Margins', LOOP_QUANTITIES),
    ],
)
def test_every_quantity_of_the_tables_is_defined_with_its_unit_and_when_it_has_no_value(
    title, figures
):
    entries = {entry.term: entry for entry in GROUPS[title]}
    for figure in figures:
        entry = entries[figure.symbol]
        assert entry.unit == unit_text(figure.unit)
        assert figure.undefined in entry.meaning, figure.symbol


def test_every_signal_is_defined_with_unit_and_sign():
    entries = {(entry.term, entry.unit, entry.meaning) for entry in GROUPS['Signals']}
    for quantity in SIGNALS:
        assert (
            quantity.symbol,
            quantity.unit,
            f'{quantity.title}: {quantity.meaning}',
        ) in entries
    signed = ('w_d', 'e', 'w_sr', 'A_x', 'C_m', 'w_d1')
    for term, _, meaning in entries:
        assert term not in signed or 'bove zero' in meaning or 'elow zero' in meaning, term


def test_every_state_is_defined():
    terms = ', '.join(entry.term for entry in GROUPS['States and limits'])
    for state in STATES:
        assert state.replace('_', ' ') in terms


def test_no_word_of_a_judgement_on_limits_is_defined():
    text = ' '.join(f'{each.term} {each.meaning}' for group in GROUPS.values() for each in group)
    for word in ('within,', 'unavoidable', 'nearly engaged', 'runaway', 'oscillating', 'VDV'):
        assert word not in text


def test_a_dash_sigma_and_a_slip_below_zero_are_explained():
    terms = {entry.term: entry.meaning for entry in GROUPS['Reading the tables']}
    assert set(terms) >= {
        '–',
        '+ and −',
        'σ',
        'w_d below zero',
        'score window',
        'control start',
        '*',
        '▲',
    }
    assert 'never locks' in terms['w_d below zero']


def test_a_page_without_the_thesis_has_no_definitions_of_it():
    groups = definitions(replace(ALL, thesis=False, shift=False))
    assert 'Gear shift' not in groups
    reading = groups['Reading the tables']
    assert 'thesis' not in ' '.join(entry.term for entry in reading)
    assert not any('Table 5.1' in entry.meaning for entry in reading)


def test_what_a_page_does_not_show_is_not_defined():
    engine = next(each for each in SIGNALS if each.key == 'w_m')
    jerk = METRICS['peak_jerk_m_s3']
    states, modes = frozenset({'engaged'}), frozenset({'lockstep'})
    groups = definitions(ShownParts([engine], [jerk], states, modes))
    terms = {subject: [each.term for each in entries] for subject, entries in groups.items()}
    assert terms == {
        'Reading the tables': ['–', '+ and −', 'score window', 'control start'],
        'Signals': ['w_m'],
        'Figures': [jerk.symbol],
        'States and limits': ['engaged'],
        'Origin': ['lockstep, realtime'],
    }
