# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Lines of controllers follow from the name alone, and are distinct on both pages for all eyes."""

import itertools
from xml.etree import ElementTree

import numpy as np
import pytest

from ddct_controllers.design.drawing.chart_style import chart_style
from ddct_controllers.design.drawing.line_looks import (
    DARK_COLOURS,
    DASHES,
    LIGHT_COLOURS,
    MARKS,
    LineLook,
    controller_look,
    css_colours,
    looks_of,
    sample_svg,
)
from ddct_controllers.design.drawing.line_styles import controller_style
from ddct_controllers.registry import own_controller_names

LINEAR_TO_XYZ = np.array(
    [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
)
EYES = {
    'normal': np.eye(3),
    'protanopic': np.array(
        [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ]
    ),
    'deuteranopic': np.array(
        [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ]
    ),
    'tritanopic': np.array(
        [
            [1.255528, -0.076749, -0.178779],
            [-0.078411, 0.930809, 0.147602],
            [0.004733, 0.691367, 0.303900],
        ]
    ),
}
"""
Matrix from linear sRGB to its simulation for each kind of colour vision, (3, 3).

From Machado, Oliveira and Fernandes (2009), severity 1.
"""


def linear(colour):
    coded = np.array([int(colour[place : place + 2], 16) for place in (1, 3, 5)]) / 255.0
    return np.where(coded <= 0.04045, coded / 12.92, ((coded + 0.055) / 1.055) ** 2.4)


def lab(rgb):
    relative = LINEAR_TO_XYZ @ np.clip(rgb, 0.0, 1.0) / np.array([0.9505, 1.0, 1.089])
    x, y, z = np.where(relative > 0.008856, np.cbrt(relative), 7.787 * relative + 16.0 / 116.0)
    return np.array([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)])


def contrast(colour, page):
    low, high = sorted(LINEAR_TO_XYZ[1] @ linear(each) for each in (colour, page))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize(
    ('colours', 'page'), [(LIGHT_COLOURS, '#ffffff'), (DARK_COLOURS, '#15181c')]
)
def test_every_colour_has_enough_contrast_with_its_page(colours, page):
    assert min(contrast(colour, page) for colour in colours) >= 3.0


@pytest.mark.parametrize('eyes', EYES)
@pytest.mark.parametrize('colours', [LIGHT_COLOURS, DARK_COLOURS], ids=['light', 'dark'])
def test_colours_differ_for_all_eyes(colours, eyes):
    simulated = [lab(EYES[eyes] @ linear(colour)) for colour in colours]
    distances = [np.linalg.norm(a - b) for a, b in itertools.combinations(simulated, 2)]
    assert min(distances) > 15.0


def test_every_packaged_controller_has_a_line_of_its_own_without_marks():
    looks = {name: controller_look(name) for name in own_controller_names()}
    assert len(set(looks.values())) == len(looks)
    assert {look.mark for look in looks.values()} == {''}


def test_the_controllers_of_table_5_1_are_solid_and_differ_in_colour():
    looks = [controller_look(name) for name in ('pi', 'ls8', 'hinf1', 'mpc3', 'mpc4')]
    assert {look.dash for look in looks} == {()}
    assert len({look.colour for look in looks}) == 5


@pytest.mark.parametrize(
    'together',
    [
        ('ls1', 'ls2', 'ls3', 'pi'),
        ('hinf1', 'hinf2', 'hinf3', 'pi'),
        ('hinf_thesis', 'hinf_fitted', 'hinf_sampled'),
        ('mpc1', 'mpc2', 'mpc3', 'mpc4'),
    ],
)
def test_controllers_that_the_thesis_draws_together_differ_in_colour(together):
    assert len({controller_look(name).colour for name in together}) == len(together)


def test_a_line_depends_on_the_name_alone():
    for order in itertools.permutations(['pi', 'ls8', 'mine', 'mpc3']):
        for shown in range(1, 5):
            looks = dict(zip(order, looks_of(order[:shown]), strict=False))
            assert looks == {name: controller_look(name) for name in order[:shown]}


def test_a_foreign_name_keeps_its_line_in_every_process_and_release():
    assert controller_look('my_controller') == LineLook(4, (2, 2), 'circle', filled=True)
    assert controller_look('my_controller') != controller_look('my_other_controller')


def test_foreign_names_spread_over_marked_lines_that_no_packaged_controller_has():
    looks = {controller_look(f'mine_{index}') for index in range(2000)}
    assert len(looks) == len(MARKS) * len(DASHES) * len(LIGHT_COLOURS)
    assert all(look.mark and look.filled for look in looks)


@pytest.mark.parametrize('name', ['ls8', 'my_controller', 'caf\u00e9', 'bad\udc80name'])
def test_runs_of_one_controller_share_colour_and_dash_and_differ_in_the_mark(name):
    looks = looks_of([name] * 5)
    assert len(set(looks)) == 5
    assert len({(look.colour, look.dash) for look in looks}) == 1
    assert not any(look.filled for look in looks[1:])
    assert looks_of([name] * 6)[5] == looks[1]


@pytest.mark.parametrize('name', ['pi', 'ls4', 'my_controller'])
def test_the_sample_of_the_page_and_the_line_of_a_figure_agree(name):
    from matplotlib.figure import Figure

    look = controller_look(name)
    sample, style = ElementTree.fromstring(sample_svg(look)), controller_style(name)
    line, *marks = sample
    assert style['color'] == look.light
    assert f'--run-{look.colour}:{look.light};' in css_colours(LIGHT_COLOURS)
    assert line.get('style') == f'stroke:var(--run-{look.colour})'
    dash = tuple(int(part) for part in line.get('stroke-dasharray', '').split())
    assert dash == look.dash
    with chart_style():
        drawn = Figure().subplots().plot([0.0, 1.0], **style)[0]
        line_style = style['linestyle']
    lengths = () if isinstance(line_style, str) else line_style[1]
    assert [1.5 * part for part in lengths] == pytest.approx(list(dash))
    assert (drawn.get_marker() != 'None') is bool(marks) is bool(look.mark)
