# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The chart of `limit` tells controllers apart, and needs no lock time that can be reached."""

import warnings

import numpy as np

from ddct_bringup.documents.chart import Marks, Panel
from ddct_bringup.floor.front import ControllerRow
from ddct_bringup.floor.front_chart import front_chart
from ddct_bringup.floor.values import Floor, Proof

PROOF = Proof('weak_duality', 4.9, 'all runs')
ROWS = [
    ControllerRow(f'c{at}', 'peak_jerk', 1.0 + 0.01 * at, 10.0 + at, None, None, None, '')
    for at in range(12)
]


def panel(least: float | None) -> Panel:
    """Return the panel of twelve controllers beside a front of one lock time."""
    floor = Floor('peak_jerk', 1.0, least, least, PROOF, None)
    (drawn,) = front_chart([floor], ROWS, 'launch').panels
    return drawn


def test_no_two_of_twelve_controllers_have_one_look() -> None:
    marks = [each for each in panel(4.9).items if isinstance(each, Marks) and each.hint]
    assert len({(mark.colour, mark.mark) for mark in marks}) == len(ROWS)
    assert all(mark.filled for mark in marks)


def test_without_a_lock_time_that_can_be_reached_the_axis_is_finite() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        span = panel(None).y.span
    assert span is not None
    assert np.isfinite(span).all()
