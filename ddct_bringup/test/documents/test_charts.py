# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""A chart is drawn by Bokeh for pages and matplotlib for files with equal data and legend."""

import re
from typing import Any

import numpy as np
import pytest

from ddct_bringup.documents.bokeh_charts import PageCharts, draw_chart
from ddct_bringup.documents.chart import (
    Area,
    Cells,
    Chart,
    ChartAxis,
    Line,
    Marks,
    Panel,
    legend,
)
from ddct_bringup.documents.chart_files import matplotlib_figure, write_chart
from ddct_bringup.documents.palette import NEUTRAL, looks

pytestmark = pytest.mark.slow

TIMES = np.array([0.0, 1.0, 2.0])
FIRST, SECOND = looks(2)
CHART = Chart(
    'pi and ls8',
    (
        Panel(
            (
                Area(TIMES, np.zeros(3), TIMES, 'no run'),
                Line(TIMES, TIMES, FIRST, 'pi'),
                Line(TIMES, 2.0 * TIMES, SECOND, 'ls8', steps=True),
                Marks(TIMES, TIMES, NEUTRAL, 'failed', 'x', filled=False),
            ),
            ChartAxis('time, s', (0.0, 2.0)),
            ChartAxis('A_x, m/s²'),
        ),
        Panel(
            (
                Cells(
                    np.array([0.0, 1.0, 2.0]),
                    np.array([-0.5, 0.5, 1.5]),
                    [['good', 'bad'], ['bad', 'good']],
                    {'good': '#d3e8f5', 'not_so_good': '#86b8dc', 'bad': '#d55e00'},
                ),
                Line(TIMES, TIMES, FIRST, 'pi'),
            ),
            ChartAxis('time, s'),
            ChartAxis('run', (-0.5, 1.5), ticks={0.0: 'first', 1.0: 'second'}),
            downward=True,
        ),
    ),
    same_x=True,
)
KEYS = ['no run', 'pi', 'ls8', 'failed', 'good', 'bad']


def test_the_legend_has_each_label_once_and_the_colours_that_occur():
    assert [key.label for key in legend(CHART)] == KEYS


def test_a_page_has_a_place_for_each_panel_and_the_legend_and_loads_the_same_values():
    from bokeh.document import Document

    page = PageCharts()
    html = page.add(CHART)
    assert re.findall(r'id="([^"]*)"', html) == ['chart-0', 'chart-1']
    assert re.findall(r'</svg>([^<]*)', html) == KEYS
    data: Any = page.data
    roots: Any = Document.from_json(data['document']).roots
    first, second = roots
    assert list(data['roots'].values()) == [first.id, second.id]
    area, line, steps, points = first.renderers
    for drawn, values in ((line, TIMES), (steps, 2.0 * TIMES), (points, TIMES)):
        source = drawn.data_source.data
        np.testing.assert_array_equal(source[drawn.glyph.y.field], values)
    assert (line.glyph.line_color, steps.glyph.line_color) == (
        FIRST.colour,
        SECOND.colour,
    )
    assert area.glyph.fill_color == NEUTRAL
    assert first.x_range is second.x_range
    assert (second.y_range.start, second.y_range.end) == (1.5, -0.5)
    quads = second.renderers[0].data_source.data
    assert list(quads['colour']) == ['#d3e8f5', '#d55e00', '#d55e00', '#d3e8f5']


def test_the_same_chart_is_the_same_document():
    first, second = PageCharts(), PageCharts()
    first.add(CHART)
    second.add(CHART)
    assert first.data['roots'] == second.data['roots']


def test_a_logarithmic_axis_and_a_title_come_on_the_figure():
    panel = Panel(
        (Line(TIMES + 1.0, TIMES, FIRST, 'pi'),), ChartAxis('gain', logarithmic=True), title='pi'
    )
    (drawn,) = draw_chart(Chart('gains', (panel,)))
    assert type(drawn.x_scale).__name__ == 'LogScale'
    assert type(drawn.y_scale).__name__ == 'LinearScale'
    assert drawn.title.text == 'pi'  # type: ignore[union-attr]
    upright = Panel(
        (Line(TIMES, TIMES + 1.0, FIRST, 'pi'),), y=ChartAxis('jerk', logarithmic=True)
    )
    (drawn,) = draw_chart(Chart('jerks', (upright,)))
    assert type(drawn.x_scale).__name__ == 'LinearScale'
    assert type(drawn.y_scale).__name__ == 'LogScale'


@pytest.mark.filterwarnings('error')
def test_a_file_and_python_have_the_chart_with_its_legend(tmp_path):
    figure = matplotlib_figure(CHART)
    first, second = figure.axes
    assert [np.asarray(line.get_ydata()).tolist() for line in first.lines] == [
        TIMES.tolist(),
        (2.0 * TIMES).tolist(),
        TIMES.tolist(),
    ]
    assert [line.get_color() for line in first.lines] == [FIRST.colour, SECOND.colour, NEUTRAL]
    assert [text.get_text() for text in figure.legends[0].get_texts()] == KEYS
    assert second.get_ylim() == (1.5, -0.5)
    assert [tick.get_text() for tick in second.get_yticklabels()] == ['first', 'second']
    assert figure.get_suptitle() == 'pi and ls8'
    write_chart(CHART, tmp_path / 'chart.svg')
    assert '<svg' in (tmp_path / 'chart.svg').read_text()
    write_chart(CHART, tmp_path / 'chart.html')
    page = (tmp_path / 'chart.html').read_text()
    assert '<h1>pi and ls8</h1>' in page
    assert page.count('<div class="chart"') == 2
