# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The page docs/controllers/h_infinity.md has the numbers that the program computes."""

from pathlib import Path

import pytest
from generator.pages import as_markdown, shown_tables
from generator.tables import h_infinity_tables

from ddct_controllers.design.analysis.worst_corner import plant_corners, worst_corner
from ddct_controllers.printed import H_INFINITY_CONTROLLERS
from ddct_plant.linear.sampling import discretise_zoh

pytestmark = pytest.mark.slow

PAGE = Path(__file__).parents[3] / 'docs' / 'controllers' / 'h_infinity.md'
HINF_SAMPLED = PAGE.with_name('hinf_sampled.md')
NOT_TO_THE_DIGIT = {'cleaning', 'controllers'}
"""Tables that depend on rounding: the fast pole at the optimum, and how double roots split."""


def test_its_tables_are_those_of_the_program():
    """Update them by: make docs KINDS=h-infinity."""
    written, computed = shown_tables('h-infinity'), as_markdown(h_infinity_tables())
    assert written.keys() == computed.keys()
    for name in written.keys() - NOT_TO_THE_DIGIT:
        assert written[name] == computed[name]
    for name in NOT_TO_THE_DIGIT:
        assert written[name].count('hinf_') == computed[name].count('hinf_')


def test_hinf1_has_the_worst_sensitivity_of_the_page():
    sampled = discretise_zoh(H_INFINITY_CONTROLLERS['hinf1'].to_state_space(), 0.01)
    worst = worst_corner(sampled, plant_corners()).sensitivity_peak
    lines = HINF_SAMPLED.read_text('utf-8').split('\n')
    row = next(line for line in lines if line.startswith('| `hinf1` |'))
    assert float(row.split('|')[-2]) == pytest.approx(worst, abs=0.005)
