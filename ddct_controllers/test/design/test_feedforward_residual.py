# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The effect of disturbances on the slip with feedforward, and the page's table of it."""

from dataclasses import replace

import numpy as np
from generator.pages import as_markdown, shown_tables
from generator.runs.feedforward_tables import (
    DRIVELINE,
    STATIC,
    engine_residual,
    load_residual,
    residuals,
)

from ddct_controllers.design.feedforward import design_feedforward

FILTER = design_feedforward(DRIVELINE)


def test_it_compensates_the_engine_torque_better_than_the_static_law_up_to_3_3_hz():
    omega = 2.0 * np.pi * np.append(np.geomspace(0.05, 3.3, 50), 3.4)
    ours = np.abs(engine_residual(FILTER, omega, DRIVELINE))
    static = np.abs(engine_residual(STATIC, omega, DRIVELINE))
    assert np.all(ours[:-1] < static[:-1])
    assert ours[-1] > static[-1]
    assert ours[omega < 2.0 * np.pi].max() < 0.03


def test_it_compensates_the_load_up_to_a_third_of_a_hertz():
    omega = 2.0 * np.pi * np.geomspace(0.05, 0.3, 20)
    assert np.abs(load_residual(FILTER, omega, DRIVELINE)).max() < 0.05


def test_without_a_filter_the_residual_is_one():
    nothing = replace(STATIC, d=np.zeros((1, 2)))
    omega = np.array([1.0, 10.0])
    for residual in (engine_residual, load_residual):
        np.testing.assert_array_equal(residual(nothing, omega, DRIVELINE), [1.0, 1.0])


def test_the_table_of_residuals():
    """Update it by: make docs KINDS=feedforward."""
    computed = as_markdown({'residual': residuals()})
    assert shown_tables('feedforward')['residual'] == computed['residual']
