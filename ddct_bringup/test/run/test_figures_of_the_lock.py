# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Metrics of the lock are measured at its instant, in runs of the packaged scenarios."""

from functools import lru_cache

import pytest

from ddct_bringup.campaign.rows import scored_headless
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import CaseSettings, KnownSettings, RunSettings

LIMITS = packaged_limits()


@lru_cache
def scored(scenario, controller, wear_gain=1.0):
    settings = RunSettings(
        KnownSettings(load_scenario(scenario)), CaseSettings(wear_gain=wear_gain)
    )
    return scored_headless(settings, controller, LIMITS).metrics


@pytest.mark.slow
@pytest.mark.parametrize(('controller', 'expected'), [('mpc1', -62.6), ('pedal_mpc', -41.0)])
def test_slip_acceleration_at_lock_is_the_exact_one(controller, expected):
    """The two samples before it differ by -3 rad/s^2: the torque rises within the last 10 ms."""
    found = scored('launch', controller)['lockup_slip_acceleration_rad_s2']
    assert found == pytest.approx(expected, abs=0.05)


@pytest.mark.parametrize('controller', ['ls3', 'hinf1'])
def test_engagement_time_is_the_exact_instant_of_the_first_lock(controller):
    metrics = scored('launch_gentle', controller)
    first, last = metrics['engagement_time_s'], metrics['time_to_final_lock_s']
    assert abs(first - round(first, 2)) > 1e-5
    assert (first == last) is (metrics['releases'] == 0)
    assert first <= last


def test_a_lock_after_the_score_window_counts_in_the_peak_jerk():
    """The plates of `ls1` lock at 2.3 s, when the window of `thesis_sticking` is over."""
    metrics = scored('thesis_sticking', 'ls1', 0.7)
    assert metrics['time_to_final_lock_s'] > 1.1
    assert metrics['peak_jerk_m_s3'] == pytest.approx(13.0, abs=0.1)


def test_a_run_with_many_releases_has_judder():
    metrics = scored('launch_gentle', 'ls3')
    assert metrics['releases'] == 14
    assert metrics['judder_rpm'] > 10.0
