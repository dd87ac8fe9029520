"""Lines of the report: distinct, visible on either page, also for colour-blind readers."""

import itertools

import numpy as np
import pytest

from ddct_bringup.report.run_marks import DARK_COLOURS, DASHES, LIGHT_COLOURS, line_looks

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
"""Machado, Oliveira and Fernandes (2009), severity 1, on linear sRGB."""


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
def test_every_colour_stands_out_from_its_page(colours, page):
    assert min(contrast(colour, page) for colour in colours) >= 3.0


@pytest.mark.parametrize('eyes', EYES)
@pytest.mark.parametrize('colours', [LIGHT_COLOURS, DARK_COLOURS], ids=['light', 'dark'])
def test_colours_differ_for_all_eyes(colours, eyes):
    seen = [lab(EYES[eyes] @ linear(colour)) for colour in colours]
    distances = [np.linalg.norm(a - b) for a, b in itertools.combinations(seen, 2)]
    assert min(distances) > 15.0


def test_runs_of_one_controller_share_its_colour():
    looks = line_looks(['pi', 'ls8', 'pi', 'ls8'], first=())
    assert looks[0].colour == looks[2].colour != looks[1].colour == looks[3].colour
    assert looks[0].dash != looks[2].dash


def test_thirty_runs_all_look_different():
    looks = line_looks([f'controller{index}' for index in range(30)], first=())
    assert len(set(looks)) == 30


def test_the_controllers_of_the_table_get_the_solid_lines():
    names = [*(f'ls{index}' for index in range(1, 10)), 'hinf1', 'pi']
    looks = dict(zip(names, line_looks(names, first=('ls8', 'hinf1', 'pi', 'mpc4')), strict=True))
    assert {looks[name].dash for name in ('ls8', 'hinf1', 'pi')} == {()}
    assert len({looks[name].colour for name in ('ls8', 'hinf1', 'pi')}) == 3


def test_more_runs_than_looks_start_again():
    count = len(LIGHT_COLOURS) * len(DASHES)
    looks = line_looks([f'controller{index}' for index in range(count + 3)], first=())
    assert len(looks) == count + 3
    assert len(set(looks[:count])) == count
