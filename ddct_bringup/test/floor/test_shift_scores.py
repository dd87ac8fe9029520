# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Scores, report and Python interface have the floors of gear shifts."""

import pytest
from shift_cases import settings_of

from ddct_bringup import api
from ddct_bringup.report.front_view import front_view
from ddct_bringup.report.page_runs import page_runs
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.floors import with_least
from ddct_bringup.scores.scored_recording import simulate_and_score
from ddct_bringup.verdict.limits import packaged_limits

pytestmark = pytest.mark.slow


def test_scores_and_report_of_a_shift_have_its_floor():
    plan = RunPlan(settings_of(handover='slip'), 'mpc3', 'headless')
    run = with_least(simulate_and_score(plan, packaged_limits()), packaged_limits())
    assert run.scores.metrics['peak_jerk_over_least'] > 1.0
    assert run.scores.least_is_bound is True
    assert 'peak_jerk_over_least' not in run.scores.null_reasons
    view = front_view([run])
    assert view.counted_from == 'the start of the inertia phase'
    chart = view.chart(page_runs([run]))
    assert chart.panels[0].x.label.startswith('time from the start of the inertia phase to')


def test_a_run_in_python_has_the_ratio_of_a_shift():
    run = api.run('ls8', scenario='upshift', handover='slip', floors=True)
    assert run.figures['peak_jerk_over_least'] > 1.0
