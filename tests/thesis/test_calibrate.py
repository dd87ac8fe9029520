# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The fit behind the scenario `thesis`: its residuals, its PI loop, and that it is found again."""

import dataclasses

import numpy as np
import pytest
from refusals import refused

from calibrate.__main__ import differences, main, require_packaged
from calibrate.problem import PARAMETERS, RANGE, ROWS, Problem, pi_growth_rate, values_of
from calibrate.search import Fit, lowest_stable
from ddct_bringup.run.headless import run_headless
from ddct_bringup.thesis.table_5_1 import ROW_OF, TOLERANCES
from ddct_plant.base.errors import DdctError, ParameterError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SCENARIO = load_scenario('thesis')
PROBLEM = Problem(SCENARIO, SCENARIO.score_window_s[1])
VALUES = np.array(values_of(SCENARIO))
GAINS = {'proportional_gain': VALUES[4], 'integral_gain': VALUES[5]}


def fit_at(*values: float, residual: float = 0.1, problem: Problem = PROBLEM) -> Fit:
    return Fit(problem, np.array(values), np.full(9, residual), np.zeros((9, 6)))


def test_no_row_of_a_predictive_controller_is_fitted() -> None:
    assert ROWS == ('ls8', 'hinf1', 'pi')


def test_the_packaged_scenario_is_that_of_its_values_and_within_every_tolerance() -> None:
    found = PROBLEM.scenario(VALUES)
    assert found == dataclasses.replace(SCENARIO, controllers={'pi': GAINS})
    residuals = PROBLEM.residuals(VALUES)
    assert np.max(np.abs(residuals)) < 1.0
    slip = run_headless(RunSettings(KnownSettings(SCENARIO)), 'ls8').slip_speed
    after = int(np.flatnonzero(slip[60:] <= 0.0)[0])
    before, last = slip[59 + after], slip[60 + after]
    time = (after - 1 + before / (before - last)) / 100
    printed = ROW_OF['ls8'].engagement_time_s
    expected = (time / printed - 1.0) / TOLERANCES['engagement_time_s']
    assert residuals[0] == pytest.approx(expected, abs=1e-6)


def test_gains_move_the_row_of_the_pi_alone() -> None:
    before, moved = PROBLEM.residuals(VALUES), VALUES.copy()
    moved[4:] *= 0.5
    after = PROBLEM.residuals(moved)
    assert np.array_equal(after[:6], before[:6])
    assert np.max(np.abs(after[6:] - before[6:])) > 0.5


def test_more_torque_at_both_ends_of_the_rise_moves_no_residual_and_at_one_end_it_does() -> None:
    before = PROBLEM.residuals(VALUES)
    both = PROBLEM.residuals(VALUES + np.array([10.0, 9.4, 0.0, 0.0, 0.0, 0.0]))
    one = PROBLEM.residuals(VALUES + np.array([0.0, 10.0, 0.0, 0.0, 0.0, 0.0]))
    assert np.max(np.abs(one - before)) > 0.2
    assert np.max(np.abs(both - before)) < 0.02


def test_engagement_time_is_continuous_where_engagement_leaves_the_window() -> None:
    """Slip reaches zero later the lower the slope, until the window ends first."""
    slopes = np.linspace(50.0, 60.0, 21)
    times = np.array([PROBLEM.residuals([*VALUES[:3], slope, *VALUES[4:]])[3] for slope in slopes])
    printed = ROW_OF['hinf1'].engagement_time_s
    times = printed * (1.0 + TOLERANCES['engagement_time_s'] * times)
    window = PROBLEM.window_end_s - SCENARIO.control_start_s
    assert times[0] > window > times[-1]
    steps = np.diff(times)
    assert np.all(steps < 0.0)
    assert np.max(np.abs(steps)) < 3.0 * np.median(np.abs(steps))


def test_scenario_of_another_kind_is_refused() -> None:
    with refused(ParameterError, 'engine'):
        values_of(load_scenario('thesis', ['engine.time_s=[0.1, 0.524]']))


def long_run(proportional_gain: float, integral_gain: float) -> Scenario:
    gains = {'proportional_gain': proportional_gain, 'integral_gain': integral_gain}
    return dataclasses.replace(SCENARIO, duration_s=20.0, controllers={'pi': gains})


def test_integral_alone_grows_at_the_rate_of_the_linear_loop() -> None:
    scenario = long_run(0.0, 0.14)
    rate = pi_growth_rate(scenario.driveline, 0.0, 0.14)
    slip = run_headless(RunSettings(KnownSettings(scenario)), 'pi').slip_speed
    change = np.diff(slip)
    turns = np.flatnonzero(change[1:] * change[:-1] < 0.0) + 1
    turns = turns[turns > 150][:8]  # after the engagement, before saturation
    swings = np.abs(np.diff(slip[turns]))
    growth = np.log(swings[-1] / swings[0]) / ((turns[-1] - turns[1]) / 100)
    assert rate > 0.1
    # A turn is known to 10 ms of the about 8 s between the first and the last.
    assert growth == pytest.approx(rate, rel=0.005)


def test_the_packaged_pi_is_stable_and_its_slip_dies_out() -> None:
    assert pi_growth_rate(SCENARIO.driveline, **GAINS) < 0.0
    slip = np.abs(run_headless(RunSettings(KnownSettings(long_run(**GAINS))), 'pi').slip_speed)
    assert np.max(slip[1500:]) < 0.02 * np.max(slip[60:200])


def test_too_much_proportional_gain_is_unstable_too() -> None:
    driveline = SCENARIO.driveline
    assert pi_growth_rate(driveline, 0.1, 0.02) < 0.0 < pi_growth_rate(driveline, 3.0, 0.02)


def test_an_unstable_pi_does_not_leave_the_search_however_well_it_fits() -> None:
    """Integral action alone is unstable: at 0.04 it grows by 0.1/s."""
    good = fit_at(*VALUES[:4], 0.1, 0.02, residual=0.5)
    better = fit_at(*VALUES[:4], 0.1, 0.03, residual=0.4)
    gains = [(0.0, 0.14), (3.0, 0.02), (0.0, 0.04)]
    unstable = [fit_at(*VALUES[:4], *each, residual=0.1) for each in gains]
    assert 0.0 < unstable[-1].pi_growth_rate < 0.2
    assert lowest_stable([good, *unstable, better]) is better
    with pytest.raises(DdctError, match='none of 3 fits has a stable PI loop'):
        lowest_stable(unstable)


def test_a_fit_elsewhere_than_the_packaged_scenario_is_an_error_with_what_moved() -> None:
    level = np.array([10.0, 10.0, 0.0, 0.0, 0.0, 0.0])
    require_packaged(fit_at(*(VALUES + level)), SCENARIO)
    slope = VALUES + np.array([0.0, 0.0, 0.0, 0.011 * RANGE[3], 0.0, 0.0])
    assert differences(fit_at(*slope), SCENARIO)[PARAMETERS[3].symbol] == pytest.approx(0.011)
    with pytest.raises(DdctError, match=r'moves reference slope .* \+1\.1 %'):
        require_packaged(fit_at(*slope), SCENARIO)
    other = Problem(SCENARIO, 1.8)
    with pytest.raises(DdctError, match=r'ends at 1\.8 s'):
        require_packaged(fit_at(*VALUES, problem=other), SCENARIO)


@pytest.mark.slow
def test_the_fit_from_the_packaged_values_returns_to_them(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(['--quick']) == 0
    assert 'not reproductions' in capsys.readouterr().out
