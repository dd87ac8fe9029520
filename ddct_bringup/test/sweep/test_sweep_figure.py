# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Failed runs differ from good ones in the figure: lines join engaged runs, others are crosses."""

from typing import Any

import numpy as np
import pytest
from made_scores import made_scores

from ddct_bringup.campaign.rows import ScoredRow
from ddct_bringup.metrics.catalogue import TABLE_5_1
from ddct_bringup.run.run_base import RunBase
from ddct_bringup.sweep.axis import axis_of
from ddct_bringup.sweep.state_map import STATE_COLOURS, edges_of
from ddct_bringup.sweep.sweep import Sweep
from ddct_bringup.sweep.sweep_figure import sweep_figure
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import ENGAGED, INVALID, LATE, NOT_ENGAGED, STATES
from ddct_controllers.design.drawing.chart_style import chart_style, save_chart
from ddct_controllers.design.drawing.line_styles import controller_style
from ddct_plant.scenario.file import ScenarioFile

TIME = TABLE_5_1[:1]


def drawn(over: list[str], controllers: list[str], runs: list[tuple[str, float | None]]) -> Any:
    """Return the figure of runs with these states and engagement times."""
    base = RunBase(ScenarioFile.read('thesis'), {}, {}, labels=())
    sweep = Sweep(base, [axis_of(text) for text in over], controllers, packaged_limits())
    scored = [made_scores(state=state, engagement_time_s=value) for state, value in runs]
    places = [*sweep.run_set.varied(range(sweep.run_set.cases))] * len(controllers)
    swept = [
        ScoredRow(index, controllers[0], 0, place, scores, 'serial')
        for index, (place, scores) in enumerate(zip(places, scored, strict=True))
    ]
    with chart_style():
        return sweep_figure(sweep, swept, TIME)


@pytest.fixture(scope='module')
def panel():
    """Return the panel of the first metric: one controller, of five runs two are engaged."""
    runs = [(LATE, 900.0), (ENGAGED, 1.0), (ENGAGED, 2.0), (NOT_ENGAGED, 2.5), (INVALID, None)]
    return drawn(['wear_gain=0.6:1.4:5'], ['pi'], runs).axes[0]


def by_marker(axes: Any, marker: str) -> Any:
    (line,) = [
        each for each in axes.lines if each.get_marker() == marker and len(each.get_xdata())
    ]
    return line


def test_a_line_joins_engaged_runs_alone(panel):
    line = by_marker(panel, 'o')
    np.testing.assert_array_equal(line.get_ydata(), [np.nan, 1.0, 2.0, np.nan, np.nan])
    assert line.get_color() == controller_style('pi')['color']


def test_no_line_joins_runs_at_words_and_each_controller_keeps_its_dash():
    runs = [(ENGAGED, 1.0), (ENGAGED, 2.0), (LATE, 3.0), (ENGAGED, 1.5)]
    panel = drawn(['clutch=linear,stick_slip'], ['pi', 'ls5'], runs).axes[0]
    drawn_lines = [each for each in panel.lines if each.get_marker() == 'o']
    for line, expected in zip(drawn_lines, ([(0.0, 1.0), (1.0, 2.0)], [(1.0, 1.5)]), strict=True):
        points = np.column_stack([line.get_xdata(), line.get_ydata()])
        apart = np.flatnonzero(np.isnan(points).any(axis=1))
        pieces = [each[~np.isnan(each).any(axis=1)] for each in np.split(points, apart)]
        assert [(each[:, 0].mean(), each[0, 1]) for each in pieces if len(each)] == expected
    styles = [line._unscaled_dash_pattern for line in drawn_lines]
    assert styles[0] != styles[1]


def test_each_other_run_has_a_cross_within_the_panel(panel):
    crosses = by_marker(panel, 'x')
    low, high = panel.get_ylim()
    np.testing.assert_allclose(crosses.get_xdata(), [0.6, 1.2, 1.4])
    np.testing.assert_allclose(crosses.get_ydata(), [high, 2.5, low])
    assert high < 8.0


@pytest.mark.parametrize(
    ('value', 'limits'), [(0.0, (-0.5, 0.5)), (2.0, (1.0, 3.0)), (-2.0, (-3.0, -1.0))]
)
def test_a_panel_whose_runs_have_one_value_has_it_in_the_middle(value, limits):
    panel = drawn(['wear_gain=0.8,1.2'], ['pi'], [(ENGAGED, value)] * 2).axes[0]
    assert panel.get_ylim() == limits


def test_a_panel_has_symbol_and_unit_as_they_are_printed(panel):
    assert panel.get_ylabel() == 't_a, s'


def test_the_title_has_controllers_axes_and_conditions():
    figure = drawn(['wear_gain=0.8,1.2'], ['pi', 'ls8'], [(ENGAGED, 1.0)] * 4)
    assert figure.axes[0].get_title() == ('pi, ls8 over wear_gain\nthesis; detailed')
    over = ['load.slope_rad=0,0.05', 'clutch=linear,stick_slip']
    figure = drawn(over, ['pi'], [(ENGAGED, 1.0)] * 4)
    first, *others = figure.get_suptitle().split('\n')
    assert first == 'pi over load.slope_rad, clutch'
    assert ' '.join(others) == 'thesis; detailed, wear gain 1'


def test_of_many_controllers_the_title_has_the_number():
    names = [f'ls{index}' for index in range(1, 10)]
    figure = drawn(['wear_gain=1,1.2'], names, [(ENGAGED, 1.0)] * 18)
    assert figure.axes[0].get_title().startswith('9 controllers over wear_gain\n')


def test_an_engaged_run_without_a_value_is_a_ring_and_no_cross():
    runs = [(ENGAGED, 1.0), (ENGAGED, None), (NOT_ENGAGED, 1.5)]
    panel = drawn(['wear_gain=0.8,1,1.2'], ['pi'], runs).axes[0]
    (ring,) = [
        line
        for line in panel.lines
        if line.get_markerfacecolor() == 'none' and len(line.get_xdata())
    ]
    assert ring.get_xdata().tolist() == [1.0]
    assert ring.get_ydata().tolist() == [panel.get_ylim()[0]]
    assert by_marker(panel, 'x').get_xdata().tolist() == [1.2]


@pytest.mark.parametrize('names', [['pi'], ['pi', 'ls8', 'mpc3']], ids=len)
def test_title_and_legends_take_no_height_from_a_panel_and_leave_none_unused(names):
    figure = drawn(['wear_gain=0.9,1'], names, [(ENGAGED, 1.0), (LATE, 2.0)] * len(names))
    figure.canvas.draw()
    height_in = figure.axes[0].get_position().height * figure.get_figheight()
    assert height_in == pytest.approx(2.3, abs=0.3)


@pytest.mark.filterwarnings('error')
def test_the_layout_is_kept_where_no_run_needs_a_mark(tmp_path):
    save_chart(drawn(['wear_gain=0.9,1'], ['pi'], [(ENGAGED, 1.0)] * 2), tmp_path / 'x.png')


def cells(axes: Any) -> list[list[str]]:
    from matplotlib.colors import to_hex

    (mesh,) = axes.collections
    colours = [to_hex(colour) for colour in mesh.to_rgba(mesh.get_array().ravel())]
    names = {colour: state for state, colour in STATE_COLOURS.items()}
    shape = mesh.get_array().shape
    return np.array([names[colour] for colour in colours]).reshape(shape).tolist()


def test_the_lanes_show_every_state_in_its_own_colour():
    states = [*STATES, *reversed(STATES)]
    figure = drawn(
        [f'wear_gain=0.6:1.2:{len(STATES)}'], ['pi', 'ls8'], [(state, 1.0) for state in states]
    )
    assert cells(figure.axes[-1]) == [list(STATES), list(reversed(STATES))]
    legend = [text.get_text() for text in figure.legends[-1].get_texts()]
    states_text = [state.replace('_', ' ') for state in STATES]
    assert legend == [*states_text, 'other than engaged', 'engaged, no value']


def test_a_map_has_the_first_key_across_and_the_second_up():
    states = [ENGAGED, LATE, NOT_ENGAGED, ENGAGED, INVALID, ENGAGED]
    figure = drawn(
        ['wear_gain=0.8,1,1.2', 'gear=1,2'], ['pi'], [(state, None) for state in states]
    )
    (axes,) = figure.axes
    assert cells(axes) == [[ENGAGED, NOT_ENGAGED, INVALID], [LATE, ENGAGED, ENGAGED]]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ('wear_gain', 'gear')


def test_a_map_without_a_controller_is_not_drawn():
    names = ['pi', 'ls5', 'ls8', 'hinf1']
    figure = drawn(['wear_gain=0.8,1.2', 'gear=1,2'], names, [(ENGAGED, None)] * 16)
    assert [axes.axison for axes in figure.axes] == [True] * 4 + [False] * 2


@pytest.mark.parametrize(
    ('over', 'shown'),
    [
        ('wear_gain=0.5:1.5:4', ['0.5', '0.8333', '1.167', '1.5']),
        ('vehicle.mass_kg=1500.1,1500.2', ['1500.1', '1500.2']),
    ],
)
def test_ticks_are_short_but_distinct(over, shown):
    number = len(shown)
    (*_, lanes) = drawn([over], ['pi'], [(ENGAGED, 1.0)] * number).axes
    assert [tick.get_text() for tick in lanes.get_xticklabels()] == shown


def test_cell_edges_are_midway_between_values():
    np.testing.assert_allclose(edges_of(np.array([0.0, 1.0, 4.0])), [-0.5, 0.5, 2.5, 5.5])
    np.testing.assert_allclose(edges_of(np.array([3.0])), [2.5, 3.5])
