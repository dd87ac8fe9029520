# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The calibration fits its stated parameters, and its analysis of the fit is correct."""

import dataclasses

import numpy as np
import pytest
from refusals import refused

from ddct_bringup.reproduction.calibration import record
from ddct_bringup.reproduction.calibration.analysis import identifiability
from ddct_bringup.reproduction.calibration.parameters import (
    BASE,
    FROZEN_GAINS,
    PARAMETERS,
    PI_ONLY,
    RANGE,
    ROWS,
    values_of,
)
from ddct_bringup.reproduction.calibration.problem import Fit, Problem, fit, row_values
from ddct_bringup.reproduction.calibration.record import check_frozen
from ddct_bringup.run.headless import run_headless
from ddct_bringup.thesis.table_5_1 import PREDICTED, THESIS_TABLE, thesis_row
from ddct_plant.base.errors import ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

pytestmark = pytest.mark.slow

SCENARIO = load_scenario('thesis')
PROBLEM = Problem(SCENARIO.score_window_s[1])
VALUES = np.array(values_of(SCENARIO))


@pytest.fixture(scope='module')
def optimum() -> Fit:
    """Return the fit from the frozen scenario."""
    return fit(PROBLEM, VALUES)


def quiet(text: str) -> None:
    """Show no progress."""


def test_no_row_of_a_predictive_controller_is_fitted():
    assert set(ROWS) == {'ls8', 'hinf1', 'pi'}
    assert {row.controller for row in THESIS_TABLE if row.use == PREDICTED} == {'mpc3', 'mpc4'}
    assert thesis_row('ls1') is None


def test_problem_builds_the_scenario_that_its_values_came_from():
    found = PROBLEM.scenario(VALUES)
    assert found == dataclasses.replace(SCENARIO, controllers={'pi': FROZEN_GAINS})


def test_refit_from_the_frozen_scenario_stays_within_one_percent_of_every_range(
    monkeypatch, optimum
):
    """It is that of `optimum`, as the fit takes most of the time."""
    asked: list[tuple[object, ...]] = []

    def fit_of(*given: object) -> Fit:
        asked.append(given)
        return optimum

    monkeypatch.setattr(record, 'fit', fit_of)
    moved = check_frozen(SCENARIO, quiet).moved
    assert asked == [(dataclasses.replace(PROBLEM, base=SCENARIO), tuple(VALUES))]
    assert len(moved) == len(PARAMETERS) - 1
    assert all(abs(share) < 0.01 for share in moved.values()), moved


def test_fit_keeps_parameters_that_are_not_free():
    problem = dataclasses.replace(PROBLEM, rows=('pi',))
    start = VALUES * np.array([1.0, 1.0, 1.0, 1.0, 0.7, 0.7])
    values = fit(problem, start, PI_ONLY).values
    assert values[:4] == tuple(VALUES[:4])
    assert values[4] != start[4]


def test_jacobian_agrees_with_central_differences():
    jacobian = PROBLEM.jacobian(VALUES)
    for index in range(1, len(PARAMETERS)):
        step = np.zeros(len(PARAMETERS))
        step[index] = 3e-4 * RANGE[index]
        slope = (PROBLEM.residuals(VALUES + step) - PROBLEM.residuals(VALUES - step)) / 6e-4
        assert jacobian[:, index] == pytest.approx(slope, rel=0.02, abs=0.3), PARAMETERS[index]


def test_pi_gains_move_no_row_but_their_own():
    before, moved = PROBLEM.residuals(VALUES), VALUES.copy()
    moved[list(PI_ONLY)] *= 0.5
    after = PROBLEM.residuals(moved)
    assert np.array_equal(after[:6], before[:6])
    assert np.max(np.abs(after[6:] - before[6:])) > 0.5


def test_weakest_direction_moves_no_residual(optimum):
    change = 10.0 * identifiability(optimum).weakest
    assert change[0] == pytest.approx(10.0)
    assert change[1] == pytest.approx(10.0, rel=0.1)
    difference = PROBLEM.residuals(VALUES + change) - PROBLEM.residuals(VALUES)
    assert np.max(np.abs(difference)) < 0.01


def test_same_rise_of_torque_by_another_path_does_move_residuals():
    """There is one insensitive direction: raising the end alone changes the residuals."""
    change = np.array([0.0, 10.0, 0.0, 0.0, 0.0, 0.0])
    difference = PROBLEM.residuals(VALUES + change) - PROBLEM.residuals(VALUES)
    assert np.max(np.abs(difference)) > 0.2


def test_standard_deviation_of_the_svd_agrees_with_the_normal_equations(optimum):
    analysis = identifiability(optimum)
    jacobian = PROBLEM.jacobian(optimum.values)
    variance = np.sum(optimum.residuals**2) / (9 - 7)
    covariance = np.linalg.inv(jacobian.T @ jacobian) * variance
    # The condition number 6000 squared leaves the inverse about nine digits.
    assert analysis.std == pytest.approx(np.sqrt(np.diag(covariance)) * RANGE, rel=1e-6)


def test_standard_error_of_a_function_is_that_of_the_normal_equations(optimum):
    """The function is the slope of C_m, compared with the covariance and a difference quotient."""
    values = np.array(optimum.values)

    def rate(at: np.ndarray) -> float:
        return float((at[1] - at[0]) / at[2])

    gradient = np.array([(rate(values + h) - rate(values - h)) / 2e-4 for h in 1e-4 * np.eye(6)])
    jacobian = PROBLEM.jacobian(values) / RANGE
    variance = np.sum(optimum.residuals**2) / (9 - 7)
    held = np.linalg.inv(jacobian[:, 1:].T @ jacobian[:, 1:]) * variance
    free = np.linalg.inv(jacobian.T @ jacobian) * variance
    expected = [gradient @ free @ gradient, gradient[1:] @ held @ gradient[1:]]
    found = identifiability(optimum).std_of(gradient)
    assert found == pytest.approx(np.sqrt(expected), rel=1e-5)


def test_engagement_time_without_engagement_is_the_time_that_the_reference_would_still_need():
    scenario = PROBLEM.scenario([*VALUES[:4], 0.0, 0.0])
    slip = run_headless(RunSettings(KnownSettings(scenario)), 'pi').slip_speed
    end = round(100 * scenario.score_window_s[1])
    assert np.all(slip[60 : end + 1] > 0.0)
    expected = (end - 60) / 100 + slip[end] / scenario.reference.slope_rad_s2
    assert row_values(scenario, 'pi')['engagement_time_s'] == pytest.approx(expected, rel=1e-12)


def test_engagement_time_is_continuous_where_engagement_leaves_the_window():
    """Slip reaches zero later the lower the slope, until the window ends first."""
    slopes = np.linspace(40.0, 60.0, 41)
    times = [
        row_values(PROBLEM.scenario([*VALUES[:3], slope, *VALUES[4:]]), 'hinf1')[
            'engagement_time_s'
        ]
        for slope in slopes
    ]
    window = PROBLEM.window_end_s - BASE.control_start_s
    assert times[0] > window > times[-1]
    steps = np.diff(times)
    assert np.all(steps < 0.0)
    assert np.max(np.abs(steps)) < 3.0 * np.median(np.abs(steps))


def test_scenario_of_another_kind_is_refused():
    with refused(ParameterError, 'thesis'):
        values_of(BASE)
