# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The growth rate that selects the kind of PI is that of the simulated loop."""

import dataclasses

import numpy as np
import pytest
from refusals import refused

from ddct_bringup.reproduction.calibration import record
from ddct_bringup.reproduction.calibration.parameters import FROZEN_GAINS, pi_growth_rate
from ddct_bringup.reproduction.calibration.problem import Fit, Problem
from ddct_bringup.reproduction.calibration.search import lowest_stable
from ddct_bringup.run.headless import run_headless
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.scenario import Scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

DURATION_S = 20.0


def long_run(proportional_gain: float, integral_gain: float) -> Scenario:
    gains = {'proportional_gain': proportional_gain, 'integral_gain': integral_gain}
    scenario = load_scenario('thesis')
    return dataclasses.replace(scenario, duration_s=DURATION_S, controllers={'pi': gains})


def peak_slip(slip: np.ndarray, first_s: float, last_s: float) -> float:
    return float(np.max(np.abs(slip[round(100 * first_s) : round(100 * last_s)])))


def test_integral_alone_grows_at_the_rate_of_the_linear_loop():
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


def test_frozen_pi_is_stable_and_its_slip_dies_out():
    scenario = load_scenario('thesis')
    assert pi_growth_rate(scenario.driveline, **FROZEN_GAINS) < 0.0
    slip = run_headless(RunSettings(KnownSettings(long_run(**FROZEN_GAINS))), 'pi').slip_speed
    assert peak_slip(slip, 15.0, 20.0) < 0.02 * peak_slip(slip, 0.6, 2.0)


def test_too_much_proportional_gain_is_unstable_too():
    driveline = load_scenario('thesis').driveline
    assert pi_growth_rate(driveline, 0.1, 0.02) < 0.0 < pi_growth_rate(driveline, 3.0, 0.02)


def optimum(proportional_gain: float, integral_gain: float, residual: float) -> Fit:
    values = (0.0, 250.0, 0.5, 110.0, proportional_gain, integral_gain)
    return Fit(Problem(2.0), values, np.array([residual]))


def test_an_unstable_pi_does_not_leave_the_search_however_well_it_fits():
    """Integral action alone is unstable: at 0.04 it grows by 0.1/s."""
    good, better = optimum(0.1, 0.02, 0.5), optimum(0.1, 0.03, 0.4)
    unstable = [optimum(0.0, 0.14, 0.1), optimum(3.0, 0.02, 0.2), optimum(0.0, 0.04, 0.3)]
    assert [one.pi_stable for one in unstable] == [False] * 3
    assert 0.0 < unstable[-1].pi_growth_rate < 0.2
    assert lowest_stable([good, *unstable, better]) is better


def test_a_search_without_a_stable_pi_ends_with_the_reason():
    with pytest.raises(DdctError, match='none of 1 fits has a stable PI loop'):
        lowest_stable([optimum(0.0, 0.14, 0.1)])


def test_a_pi_that_only_rounding_makes_unstable_does_not_leave_the_calibration(monkeypatch):
    """K_p = 0.0023 stabilises K_i = 0.04, the 0.002 that the scenario would keep does not."""
    chosen = optimum(0.0023, 0.04, 0.1)
    assert chosen.pi_stable
    monkeypatch.setattr(record, 'search', lambda _: ([], [chosen]))
    with refused(DdctError, 'gains'):
        record.calibrate(print)


def test_a_frozen_scenario_with_an_unstable_pi_is_refused():
    scenario = load_scenario('thesis')
    unstable = {'pi': {'proportional_gain': 0.0, 'integral_gain': 0.14}}
    with refused(DdctError, 'gains'):
        record.check_frozen(dataclasses.replace(scenario, controllers=unstable), print)
