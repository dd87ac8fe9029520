# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Failed runs differ from good ones in the chart: lines join engaged runs, others are crosses."""

import numpy as np
import pytest
from made_scores import made_scores

from ddct_bringup.campaign.rows import ScoredRow
from ddct_bringup.documents.chart import Cells, Chart, Line, Marks, Panel, legend
from ddct_bringup.documents.palette import looks
from ddct_bringup.metrics.catalogue import TABLE_5_1
from ddct_bringup.run.run_base import RunBase
from ddct_bringup.sweep.axis import axis_of
from ddct_bringup.sweep.state_map import STATE_COLOURS, edges_of
from ddct_bringup.sweep.sweep import Sweep
from ddct_bringup.sweep.sweep_chart import NO_VALUE, OTHER, sweep_chart
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.state import ENGAGED, INVALID, LATE, NOT_ENGAGED, STATES
from ddct_plant.scenario.file import ScenarioFile

TIME = TABLE_5_1[:1]


def drawn(over: list[str], controllers: list[str], runs: list[tuple[str, float | None]]) -> Chart:
    """Return the chart of runs with these states and engagement times."""
    base = RunBase(ScenarioFile.read('thesis'), {}, {}, labels=())
    sweep = Sweep(base, [axis_of(text) for text in over], controllers, packaged_limits())
    scored = [made_scores(state=state, engagement_time_s=value) for state, value in runs]
    places = [*sweep.run_set.varied(range(sweep.run_set.cases))] * len(controllers)
    swept = [
        ScoredRow(index, controllers[0], 0, place, scores, 'serial')
        for index, (place, scores) in enumerate(zip(places, scored, strict=True))
    ]
    return sweep_chart(sweep, swept, TIME)


@pytest.fixture(scope='module')
def panel():
    """Return the panel of the first metric: one controller, of five runs two are engaged."""
    runs = [(LATE, 900.0), (ENGAGED, 1.0), (ENGAGED, 2.0), (NOT_ENGAGED, 2.5), (INVALID, None)]
    return drawn(['wear_gain=0.6:1.4:5'], ['pi'], runs).panels[0]


def marked(panel: Panel, meaning: str) -> Marks:
    """Return the marks of the runs with a meaning."""
    (points,) = [
        each
        for each in panel.items
        if isinstance(each, Marks) and each.hint.endswith(meaning) and len(each.x)
    ]
    return points


def named_lines(panel: Panel) -> list[Line]:
    return [each for each in panel.items if isinstance(each, Line) and each.label]


def test_a_line_joins_engaged_runs_alone(panel):
    (line,) = named_lines(panel)
    np.testing.assert_array_equal(line.y, [np.nan, 1.0, 2.0, np.nan, np.nan])
    assert line.look == looks(1)[0]


def test_no_line_joins_runs_at_words_and_each_controller_keeps_its_line():
    runs = [(ENGAGED, 1.0), (ENGAGED, 2.0), (LATE, 3.0), (ENGAGED, 1.5)]
    panel = drawn(['clutch=linear,stick_slip'], ['pi', 'ls5'], runs).panels[0]
    lines = named_lines(panel)
    for line, expected in zip(lines, ([(0.0, 1.0), (1.0, 2.0)], [(1.0, 1.5)]), strict=True):
        points = np.column_stack([line.x, line.y])
        apart = np.flatnonzero(np.isnan(points).any(axis=1))
        pieces = [each[~np.isnan(each).any(axis=1)] for each in np.split(points, apart)]
        assert [(each[:, 0].mean(), each[0, 1]) for each in pieces if len(each)] == expected
    assert [line.look for line in lines] == looks(2)


def test_each_other_run_has_a_cross_within_the_panel(panel):
    crosses = marked(panel, OTHER)
    low, high = panel.y.span
    np.testing.assert_allclose(crosses.x, [0.6, 1.2, 1.4])
    np.testing.assert_allclose(crosses.y, [high, 2.5, low])
    assert crosses.mark == 'x'
    assert high < 8.0


@pytest.mark.parametrize(
    ('value', 'limits'), [(0.0, (-0.5, 0.5)), (2.0, (1.0, 3.0)), (-2.0, (-3.0, -1.0))]
)
def test_a_panel_whose_runs_have_one_value_has_it_in_the_middle(value, limits):
    panel = drawn(['wear_gain=0.8,1.2'], ['pi'], [(ENGAGED, value)] * 2).panels[0]
    assert panel.y.span == limits


def test_a_panel_has_symbol_and_unit_as_they_are_printed(panel):
    assert panel.y.label == 't_a, s'


def test_the_title_has_controllers_axes_and_conditions():
    chart = drawn(['wear_gain=0.8,1.2'], ['pi', 'ls8'], [(ENGAGED, 1.0)] * 4)
    assert (chart.title, chart.conditions) == ('pi, ls8 over wear_gain', 'thesis; detailed')
    over = ['load.slope_rad=0,0.05', 'clutch=linear,stick_slip']
    chart = drawn(over, ['pi'], [(ENGAGED, 1.0)] * 4)
    assert chart.title == 'pi over load.slope_rad, clutch'
    assert chart.conditions == 'thesis; detailed, wear gain 1'


def test_of_many_controllers_the_title_has_the_number():
    names = [f'ls{index}' for index in range(1, 10)]
    chart = drawn(['wear_gain=1,1.2'], names, [(ENGAGED, 1.0)] * 18)
    assert chart.title == '9 controllers over wear_gain'


def test_an_engaged_run_without_a_value_is_a_ring_and_no_cross():
    runs = [(ENGAGED, 1.0), (ENGAGED, None), (NOT_ENGAGED, 1.5)]
    chart = drawn(['wear_gain=0.8,1,1.2'], ['pi'], runs)
    assert NO_VALUE in [key.label for key in legend(chart)]
    panel = chart.panels[0]
    ring = marked(panel, NO_VALUE)
    assert (ring.x.tolist(), ring.y.tolist()) == ([1.0], [panel.y.span[0]])
    assert (ring.mark, ring.filled) == ('circle', False)
    assert marked(panel, OTHER).x.tolist() == [1.2]


def cells(panel: Panel) -> Cells:
    (found,) = [each for each in panel.items if isinstance(each, Cells)]
    return found


def test_the_lanes_show_every_state_in_its_own_colour():
    states = [*STATES, *reversed(STATES)]
    chart = drawn(
        [f'wear_gain=0.6:1.2:{len(STATES)}'], ['pi', 'ls8'], [(state, 1.0) for state in states]
    )
    assert cells(chart.panels[-1]).names == [list(STATES), list(reversed(STATES))]
    assert len({STATE_COLOURS[state] for state in STATES}) == len(STATES)
    states_text = [state.replace('_', ' ') for state in STATES]
    assert [key.label for key in legend(chart)] == [OTHER, 'pi', 'ls8', *states_text]


def test_a_map_has_the_first_key_across_and_the_second_up():
    states = [ENGAGED, LATE, NOT_ENGAGED, ENGAGED, INVALID, ENGAGED]
    chart = drawn(['wear_gain=0.8,1,1.2', 'gear=1,2'], ['pi'], [(state, None) for state in states])
    (panel,) = chart.panels
    assert cells(panel).names == [[ENGAGED, NOT_ENGAGED, INVALID], [LATE, ENGAGED, ENGAGED]]
    assert (panel.x.label, panel.y.label, panel.title) == ('wear_gain', 'gear', 'pi')


def test_each_controller_has_a_map():
    names = ['pi', 'ls5', 'ls8', 'hinf1']
    chart = drawn(['wear_gain=0.8,1.2', 'gear=1,2'], names, [(ENGAGED, None)] * 16)
    assert [panel.title for panel in chart.panels] == names


@pytest.mark.parametrize(
    ('over', 'shown'),
    [
        ('wear_gain=0.5:1.5:4', ['0.5', '0.8333', '1.167', '1.5']),
        ('vehicle.mass_kg=1500.1,1500.2', ['1500.1', '1500.2']),
    ],
)
def test_ticks_are_short_but_distinct(over, shown):
    lanes = drawn([over], ['pi'], [(ENGAGED, 1.0)] * len(shown)).panels[-1]
    assert list(lanes.x.ticks.values()) == shown


def test_cell_edges_are_midway_between_values():
    np.testing.assert_allclose(edges_of(np.array([0.0, 1.0, 4.0])), [-0.5, 0.5, 2.5, 5.5])
    np.testing.assert_allclose(edges_of(np.array([3.0])), [2.5, 3.5])
