# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The report draws the least peak jerk over the lock time, with the runs that have a floor."""

import re

import pytest

from ddct_bringup.report.evidence import evidence_of
from ddct_bringup.report.front_view import front_view
from ddct_bringup.report.page import report_page
from ddct_bringup.run.plan import RunPlan
from ddct_bringup.scores.floors import with_floors
from ddct_bringup.scores.scored_recording import ScoredRecording, simulate_and_score
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.scenario.file import load_scenario
from ddct_plant.scenario.settings import RunSettings

pytestmark = pytest.mark.slow

LEAST = 4.917
"""Least peak jerk in m/s^3 of `launch` with a lock after 1.121 s."""
LESS = 3e-4
"""Share by which a bound with a certificate may be below the least, printed with four digits."""


def run_of(controller: str, clutch: str = 'stick_slip', *, floors: bool = True) -> ScoredRecording:
    """Return a run in `launch` with its floor of peak jerk."""
    settings = RunSettings(load_scenario('launch'), clutch=clutch)
    run = simulate_and_score(RunPlan(settings, controller, 'headless'), packaged_limits())
    return with_floors(run, ('peak_jerk',) if floors else None, packaged_limits())


def test_the_runs_with_a_floor_are_above_the_line_of_the_least() -> None:
    view = front_view([run_of('hinf2'), run_of('ls8'), run_of('hinf_sampled')])
    assert view is not None
    assert [run.index for run in view.runs] == [1, 2]
    heights = [y for _, y in view.line]
    assert heights == sorted(heights, reverse=True)
    ls8, sampled = view.runs
    assert max(ls8.x, sampled.x) < view.line[-1][0] - 0.1
    assert ls8.y > sampled.y > max(y for x, y in view.line if x >= ls8.x - 0.1)
    least = re.search(r'lock 1.121 s after control start, 11.27 m/s³, least (.*) m/s³', ls8.text)
    assert least is not None
    assert float(least[1]) == pytest.approx(LEAST, rel=LESS)
    assert all(0.0 <= share <= 1.0 for _, share in (*view.across, *view.up))


def test_without_a_floor_there_is_no_drawing() -> None:
    assert front_view([run_of('ls8', floors=False), run_of('hinf2')]) is None


def test_the_page_has_the_drawing_and_the_least_beside_the_values() -> None:
    runs = [run_of('ls8')]
    page = report_page(runs, evidence_of(runs), packaged_limits())
    assert '<svg class="floor-front"' in page
    assert '<title>ls8: lock 1.121 s' in page
    beside = re.findall(r'<small class="floor">least ([0-9.]+)</small>', page)
    assert pytest.approx(LEAST, rel=LESS) in [float(least) for least in beside]
    plain = [run_of('ls8', floors=False)]
    assert '<svg class="floor-front"' not in report_page(
        plain, evidence_of(plain), packaged_limits()
    )
