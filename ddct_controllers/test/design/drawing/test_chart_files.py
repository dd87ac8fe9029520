# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Files of a figure: data with headings and units, and the same bytes for the same figure."""

import csv
import re

import numpy as np
import pytest

from ddct_controllers.design.drawing import charts
from ddct_controllers.design.drawing.chart_style import (
    chart_style,
    figure_data,
    figure_files,
    new_chart,
    save_figure,
)
from ddct_controllers.design.drawing.charts import (
    draw_bound,
    draw_nichols,
    draw_step_response,
    write_design_charts,
)
from ddct_controllers.design.drawing.nichols import nichols_curve
from ddct_controllers.design.loop_shaping.specifications import TimeSpecifications
from ddct_controllers.from_file.designed import DesignedController
from ddct_controllers.printed import PRINTED_CONTROLLERS

pytestmark = pytest.mark.slow

TIME = np.linspace(0.0, 1.0, 5)


def two_panels():
    figure, (left, right) = new_chart('w_d and its rate', panels=2)
    left.set(title='speed', xlabel='Time, s', ylabel='w_d, rpm')
    left.plot(TIME, TIME**2, label='pi')
    left.plot(TIME, TIME**3, label='ls8')
    left.plot(TIME[:2], TIME[:2], label='short')
    left.plot(TIME, TIME)
    left.axhline(1.0, label='limit')
    right.set(title='rate', xlabel='Time, s', ylabel='dw_d/dt, rpm/s')
    right.plot(TIME, 2.0 * TIME, label='pi')
    return figure


@pytest.fixture(scope='module')
def saved(tmp_path_factory):
    """Return a folder with the files of two figures that are the same."""
    folder = tmp_path_factory.mktemp('saved')
    with chart_style():
        for name in ('first', 'second'):
            save_figure(two_panels(), folder, name)
    return folder


def test_the_data_are_the_labelled_lines_under_headings_with_units(saved):
    rows = list(csv.reader((saved / 'first.csv').read_text(encoding='utf-8').splitlines()))
    assert rows[0] == [
        'speed: pi and ls8: Time, s',
        'speed: pi: w_d, rpm',
        'speed: ls8: w_d, rpm',
        'speed: short: Time, s',
        'speed: short: w_d, rpm',
        'rate: Time, s',
        'rate: pi: dw_d/dt, rpm/s',
    ]
    assert rows[3] == ['0.5', '0.25', '0.125', '', '', '0.5', '1']


def test_the_same_figure_gives_the_same_files(saved):
    first, second = (figure_files(saved, name) for name in ('first', 'second'))
    assert [file.read_bytes() for file in first] == [file.read_bytes() for file in second]
    assert first[1].read_text(encoding='utf-8').startswith('<?xml')
    assert sorted(saved.iterdir()) == sorted([*first, *second])


def test_a_reference_across_the_panel_is_no_data():
    figure, (axes,) = new_chart('step')
    draw_step_response(axes, {'pi': (TIME, TIME)})
    headings = [heading for heading, _ in figure_data(figure)]
    assert len(headings) == 2
    assert headings[0] == 'Time, s'


def test_a_chart_with_a_bound_has_all_frequencies_between_its_edges():
    _, (axes,) = new_chart('|S|')
    omega = np.geomspace(0.1, 100.0, 4)
    draw_bound(axes, omega, {'S': omega / (omega + 1.0)}, ('bound', np.full(4, 1.2)))
    assert axes.get_xlim() == (0.1, 100.0)


def test_the_step_chart_has_lines_at_the_specified_rise_time_and_overshoot(monkeypatch, tmp_path):
    figures = {}
    monkeypatch.setattr(
        charts, 'save_figure', lambda figure, folder, name: figures.update({name: figure})
    )
    designed = DesignedController('mine', PRINTED_CONTROLLERS['ls8'])
    write_design_charts(tmp_path, designed, TimeSpecifications(rise_time_s=0.3, overshoot=0.08))
    assert list(figures) == ['mine_nyquist', 'mine_nichols', 'mine_step']
    lines = [line.get_data() for line in figures['mine_step'].axes[0].lines]
    across = [y[0] for x, y in lines if list(x) == [0.0, 1.0]]
    upright = [x[0] for x, y in lines if list(y) == [0.0, 1.0]]
    assert (across, upright) == ([1.08, 1.0], [0.3])


def grid_labels() -> dict[str, tuple[float, float]]:
    """Return phase and magnitude of the open loop at each label of the grid."""
    from matplotlib.text import Text

    figure, (axes,) = new_chart('Nichols')
    loop = nichols_curve(1.0 / (1j * np.geomspace(0.1, 10.0, 50)))
    draw_nichols(axes, {'L': loop}, TimeSpecifications(rise_time_s=0.3, overshoot=0.08))
    texts = [each for each in axes.get_children() if isinstance(each, Text) and each.get_text()]
    return {each.get_text(): each.get_position() for each in texts}


@pytest.mark.parametrize('unit', [' dB', '°'])
def test_each_contour_of_the_nichols_grid_has_its_value_where_the_closed_loop_has_it(unit):
    labels = {
        text: at for text, at in grid_labels().items() if re.fullmatch(f'−?\\d+{unit}', text)
    }
    assert len(labels) >= 9
    for text, (phase_deg, magnitude_db) in labels.items():
        value = float(text.removesuffix(unit).replace('−', '-'))
        loop = 10.0 ** (magnitude_db / 20.0) * np.exp(1j * np.radians(phase_deg))
        closed = loop / (1.0 + loop)
        if unit == ' dB':
            assert 20.0 * np.log10(abs(closed)) == pytest.approx(value, abs=0.1)
        else:
            assert np.degrees(np.angle(closed)) % 360.0 == pytest.approx(value % 360.0, abs=1.0)
