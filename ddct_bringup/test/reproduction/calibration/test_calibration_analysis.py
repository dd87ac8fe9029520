# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Derived quantities of the calibration have their own errors; left-out rows their own fits."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ddct_bringup.reproduction.calibration import analysis
from ddct_bringup.reproduction.calibration.parameters import PARAMETERS, PI_ONLY, ROWS
from ddct_bringup.reproduction.calibration.problem import Fit, Problem
from ddct_bringup.reproduction.calibration.record import _torque_and_slopes
from ddct_bringup.thesis.table_metrics import TABLE_METRICS

VALUES = np.array([20.0, 280.0, 0.5, 105.0, 0.05, 0.1])


def test_the_error_of_a_derived_quantity_is_that_of_its_derivatives():
    gradients = []

    def std_of(gradient):
        gradients.append(gradient)
        return 1.0, 0.5

    stub: Any = SimpleNamespace(std_of=std_of)
    entries = _torque_and_slopes(VALUES.tolist(), stub)
    names = [entry.quantity for entry in entries]
    assert names[2:4] == ['rise of C_m', 'slope of C_m']
    for place, gradient in enumerate(gradients[: len(entries)]):
        expected = []
        for step in 1e-4 * np.eye(len(VALUES)):
            above, below = (
                _torque_and_slopes((VALUES + change).tolist(), stub)[place].value
                for change in (step, -step)
            )
            expected.append((above - below) / 2e-4)
        assert gradient == pytest.approx(expected, rel=1e-5, abs=1e-8), names[place]


def test_the_gains_of_the_pi_are_fitted_to_its_row_alone_where_that_is_left_out(monkeypatch):
    asked = []

    def best_fit(problem, values, free):
        asked.append((problem.rows, free))
        moved = np.add(values, np.isin(range(len(PARAMETERS)), free))
        return Fit(problem, tuple(moved.tolist()), np.zeros(3 * len(problem.rows)))

    figures = dict.fromkeys(TABLE_METRICS, 1.0)
    scenarios = []
    monkeypatch.setattr(analysis, '_best_fit', best_fit)
    monkeypatch.setattr(analysis, 'row_values', lambda scenario, row: figures)
    monkeypatch.setattr(Problem, 'scenario', lambda self, values: scenarios.append(values))
    optimum = Fit(Problem(1.7), tuple(VALUES.tolist()), np.zeros(9))
    found = analysis.leave_one_row_out(optimum, lambda text: None)
    every = tuple(range(len(PARAMETERS)))
    shared = tuple(index for index in every if index not in PI_ONLY)
    kept = {row: tuple(other for other in ROWS if other != row) for row in ROWS}
    assert sorted(asked) == sorted(
        [*((kept[row], shared if row == 'pi' else every) for row in ROWS), (('pi',), PI_ONLY)]
    )
    assert {entry.row: entry.gains_from_row for entry in found} == {
        row: row == 'pi' for row in ROWS
    }
    np.testing.assert_allclose(scenarios, [VALUES + 1.0] * len(ROWS))
