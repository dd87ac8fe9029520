# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Lines that share a colour or a dash get different ones; the others stay as they are."""

from itertools import combinations

from ddct_controllers.design.drawing.distinct_lines import distinct_styles
from ddct_controllers.design.drawing.line_styles import REFERENCE_LINE, controller_style


def test_a_line_keeps_what_no_other_line_has():
    styles = {name: controller_style(name) for name in ('ls8', 'hinf2', 'ls4')}
    apart = distinct_styles(styles)
    assert apart['ls8'] == styles['ls8']
    assert apart['hinf2']['linestyle'] == styles['hinf2']['linestyle']
    assert apart['ls4'] == styles['ls4']
    assert apart['hinf2']['color'] != styles['hinf2']['color'], 'that of ls8, which is solid'


def test_eight_lines_differ_in_both_and_the_reference_stays_as_it_is():
    names = ('ls4', 'ls5', 'ls6', 'ls7', 'ls8', 'ls9', 'pi')
    styles = {'reference': REFERENCE_LINE} | {name: controller_style(name) for name in names}
    apart = distinct_styles(styles)
    assert list(apart) == list(styles)
    assert apart['reference'] == REFERENCE_LINE
    for one, other in combinations(apart.values(), 2):
        assert one['color'] != other['color']
        assert one['linestyle'] != other['linestyle']


def test_two_runs_of_one_controller_differ_too():
    apart = distinct_styles({f'{n}': controller_style('hinf2', n) for n in range(2)})
    assert apart['0']['color'] != apart['1']['color']
    assert apart['0']['linestyle'] != apart['1']['linestyle']


def test_more_lines_than_looks_are_drawn_all_the_same():
    styles = {str(index): controller_style(f'mine_{index}') for index in range(12)}
    assert len(distinct_styles(styles)) == 12
