# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""In each figure of the gallery no two lines have equal colours, or dashes that are alike."""

from itertools import combinations
from typing import Any

import pytest
from samples import sampled

from ddct_bringup.reproduction.figures.command import collect_figures
from ddct_controllers.design.drawing.chart_style import chart_style

pytestmark = pytest.mark.slow

FIGURES = {figure.number: figure for figure in collect_figures()}


def dash_points(line: Any) -> tuple[float, ...]:
    """Return the lengths of line and gap in points, empty for a solid line."""
    lengths = line._unscaled_dash_pattern[1]  # matplotlib has no public name for it
    return tuple(line.get_linewidth() * each for each in lengths or ())


def dashes_alike(one: tuple[float, ...], other: tuple[float, ...]) -> bool:
    """Return whether two dashes have as many parts, nearly one period and nearly one share."""
    if len(one) != len(other):
        return False
    if not one:
        return True
    periods, shares = (
        [measure(each) for each in (one, other)]
        for measure in (sum, lambda each: sum(each[::2]) / sum(each))
    )
    return max(periods) < 1.5 * min(periods) and abs(shares[0] - shares[1]) < 0.1


def of_the_legend(axes):
    return [
        line
        for line in axes.get_lines()
        if not str(line.get_label()).startswith('_') and line.get_linestyle() != 'None'
    ]


@pytest.mark.parametrize('number', sampled(FIGURES, every=4))
def test_each_line_of_a_figure_has_its_own_colour_and_its_own_dash(number):
    from matplotlib.colors import to_hex

    with chart_style():
        chart, _ = FIGURES[number].draw()
    for axes in chart.axes:
        for one, other in combinations(of_the_legend(axes), 2):
            pair = f'{one.get_label()} and {other.get_label()}'
            assert to_hex(one.get_color()) != to_hex(other.get_color()), pair
            assert not dashes_alike(dash_points(one), dash_points(other)), pair


def test_dashes_that_differ_in_line_width_alone_count_as_equal():
    assert dashes_alike((7.0, 3.0), (4.8, 2.1))
    assert dashes_alike((), ())
    assert not dashes_alike((7.0, 3.0), (2.0, 2.0))
    assert not dashes_alike((9.0, 3.0, 2.0, 3.0), (9.0, 3.0))
