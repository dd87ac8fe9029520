# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The project's H-infinity controllers in the frozen scenario, beside Hinf1 (Table 5.1)."""

import numpy as np
import pytest
from tight_tolerance import tight_tolerance_run

from ddct_bringup.metrics.metric import Metrics
from ddct_bringup.reproduction.study_run import thesis_run
from ddct_bringup.thesis.table_5_1 import thesis_row
from ddct_bringup.thesis.table_metrics import TABLE_METRICS
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import KnownSettings, RunSettings

SCENARIO = load_scenario('thesis')


def metrics(controller: str, wear_gain: float = 1.0) -> Metrics:
    return thesis_run(controller, 'detailed', wear_gain).metrics


@pytest.fixture(scope='module')
def sampled() -> Metrics:
    return metrics('hinf_sampled')


@pytest.mark.parametrize('figure', TABLE_METRICS)
def test_hinf_sampled_dominates_hinf1_as_computed_by_at_least_4_percent(sampled, figure):
    assert sampled[figure] < 0.96 * metrics('hinf1')[figure]


@pytest.mark.parametrize('figure', TABLE_METRICS)
def test_hinf_sampled_dominates_hinf1_as_printed_by_at_least_2_percent(sampled, figure):
    assert sampled[figure] < 0.98 * getattr(thesis_row('hinf1'), figure)


@pytest.fixture(scope='module', params=['hinf_sampled', 'hinf1'])
def integrated(request):
    """Return the name of a controller and the signals of its run as scipy integrates it."""
    return request.param, tight_tolerance_run(RunSettings(KnownSettings(SCENARIO)), request.param)


def test_its_figures_are_those_of_a_loop_that_scipy_integrates(integrated):
    """The values in Table 5.1 and beside it, from other code for signals and formulas."""
    name, signals = integrated
    time = np.arange(len(signals['w_d'])) / 100.0
    after = time >= SCENARIO.control_start_s - 1e-9
    crossing = np.flatnonzero(after & (signals['w_d'] <= 0.0))[0]
    zero = np.interp(0.0, signals['w_d'][[crossing, crossing - 1]], time[[crossing, crossing - 1]])
    first, last = SCENARIO.score_window_s
    window = (time >= first - 1e-9) & (time <= last + 1e-9)
    expected = [
        zero - SCENARIO.control_start_s,
        signals['w_sr'][window].std() * 30.0 / np.pi,
        signals['A_x'][window].std(),
    ]
    found = [metrics(name)[figure] for figure in TABLE_METRICS]
    assert found == pytest.approx(expected, rel=2e-3)


def test_it_goes_through_zero_and_comes_back_as_far_as_scipy_finds(integrated):
    name, signals = integrated
    lowest = thesis_run(name, 'detailed', 1.0).trajectory.slip_speed.min()
    assert lowest == pytest.approx(signals['w_d'].min(), rel=2e-3)


def test_it_goes_further_through_zero_than_hinf1():
    """A slower, smoother loop goes further through zero."""
    sampled, hinf1 = (
        thesis_run(name, 'detailed', 1.0).trajectory.slip_speed.min()
        for name in ('hinf_sampled', 'hinf1')
    )
    assert sampled < 1.3 * hinf1 < 0.0


@pytest.mark.parametrize('name', ['hinf_thesis', 'hinf_fitted'])
def test_designs_without_hold_and_delay_are_fast_and_shake_the_driveline(name):
    """Faster than Hinf1, at twice its torsion speed or more."""
    found, printed = metrics(name), metrics('hinf1')
    assert found['engagement_time_s'] < 0.8 * printed['engagement_time_s']
    assert found['torsion_speed_std_rpm'] > 1.9 * printed['torsion_speed_std_rpm']
