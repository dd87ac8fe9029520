# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Lines of a page are distinct, on a light and a dark page and for all eyes."""

import itertools
from xml.etree import ElementTree

import numpy as np
import pytest

from ddct_bringup.documents.palette import LineLook, looks, point_mark, sample_svg
from ddct_controllers.design.drawing.line_styles import COLOURS, DASHES

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


PAGES = {'light': '#ffffff', 'dark': '#121417'}


@pytest.mark.parametrize('page', PAGES)
def test_every_colour_has_enough_contrast_with_its_page(page):
    assert min(contrast(colour, PAGES[page]) for colour in COLOURS) >= 3.0


@pytest.mark.parametrize('eyes', EYES)
def test_colours_differ_for_all_eyes(eyes):
    simulated = [lab(EYES[eyes] @ linear(colour)) for colour in COLOURS]
    distances = [np.linalg.norm(a - b) for a, b in itertools.combinations(simulated, 2)]
    assert min(distances) > 15.0


def test_the_lines_of_a_page_have_the_first_free_colours_then_dashes_then_marks():
    of_page = looks(31)
    assert [look.colour for look in of_page[:5]] == list(COLOURS)
    assert {(look.dash, look.mark) for look in of_page[:5]} == {((), '')}
    assert of_page[5] == LineLook(COLOURS[0], DASHES[1])
    assert of_page[30] == LineLook(COLOURS[0], (), 'circle')


def test_no_two_of_20_points_look_alike():
    points = {(look.colour, point_mark(at)) for at, look in enumerate(looks(20))}
    assert len(points) == 20
    assert point_mark(20) == point_mark(0) == 'circle'


def test_no_two_of_150_lines_look_alike():
    assert len(set(looks(150))) == 150
    assert looks(151)[150] == looks(1)[0]


@pytest.mark.parametrize('look', [looks(1)[0], looks(8)[7], looks(31)[30]])
def test_the_sample_has_colour_dash_and_mark_of_the_line(look):
    line, *marks = ElementTree.fromstring(sample_svg(look))
    assert line.get('stroke') == look.colour
    dash = tuple(int(part) for part in line.get('stroke-dasharray', '').split())
    assert dash == look.dash
    assert [mark.get('fill') for mark in marks] == ([look.colour] if look.mark else [])
