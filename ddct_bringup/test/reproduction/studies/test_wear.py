# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Rows and columns of the studies of wear."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ddct_bringup.reproduction.studies import wear as module
from ddct_bringup.reproduction.studies.wear import _largest_in_last_part, wear, wear_feedforward
from ddct_bringup.reproduction.study_run import thesis_run


@pytest.mark.parametrize(
    ('study', 'architecture', 'wear_gains'),
    [
        (wear, 'detailed', (0.7, 0.85, 1.0, 1.15, 1.3)),
        (wear_feedforward, 'feedforward', (0.4, 0.7, 1.0, 1.3, 2.5)),
    ],
)
def test_a_study_has_a_row_for_each_wear_gain_with_the_slip_in_its_architecture(
    monkeypatch, study, architecture, wear_gains
):
    """Here of LS8 alone, which is quick."""
    monkeypatch.setattr(module, 'CONTROLLERS', ('ls8',))
    found = study()
    assert architecture in found.title
    assert [row[:2] for row in found.rows] == [('ls8', f'{gain:g}') for gain in wear_gains]
    for row, gain in zip(found.rows, wear_gains, strict=True):
        run = thesis_run('ls8', architecture, gain)
        assert float(row[2]) == pytest.approx(run.slip_rpm[60], abs=0.5)


def test_the_largest_slip_is_that_of_the_last_half_second_to_either_side():
    slip_rpm = np.zeros(300)
    slip_rpm[[249, 250, 299]] = 90.0, -7.0, 5.0
    run: Any = SimpleNamespace(slip_rpm=slip_rpm)
    assert _largest_in_last_part(run) == 7.0
