# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The report draws the least peak jerk over the lock time, with every run that has a least."""

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
from ddct_plant.scenario.settings import KnownSettings, RunSettings

pytestmark = pytest.mark.slow

LIMITS = packaged_limits()
LEAST = 4.917
"""Least peak jerk in m/s^3 of `launch` with a lock after 1.121 s."""
LESS = 3e-4
"""Share by which a bound with a certificate may be below the least, printed with four digits."""


def runs_of(*controllers: str, floors: bool = True) -> list[ScoredRecording]:
    """Return runs in `launch` with their jerk over the least."""
    settings = RunSettings(KnownSettings(load_scenario('launch')))
    plans = [RunPlan(settings, each, 'headless') for each in controllers]
    scored = [simulate_and_score(plan, LIMITS) for plan in plans]
    return with_floors(scored, LIMITS) if floors else scored


@pytest.fixture(scope='module')
def runs() -> list[ScoredRecording]:
    """Return a run that slips again, two of the clutch alone, and one that commands the engine."""
    return runs_of('hinf2', 'ls8', 'hinf_sampled', 'torque_estimator')


def test_every_run_is_on_the_front_and_hollow_where_the_least_is_no_bound(runs) -> None:
    view = front_view(runs, LIMITS.rules)
    assert view is not None
    assert [(run.index, run.bound) for run in view.runs] == [
        (0, False),
        (1, True),
        (2, True),
        (3, False),
    ]
    assert all(0.0 <= share <= 1.0 for _, share in (*view.across, *view.up))
    page = report_page(runs, evidence_of(runs), LIMITS)
    drawing = page[page.index('<svg class="floor-front"') :].partition('</svg>')[0]
    hollow = re.findall(
        r'<g data-run="(\d)"><title>[^<]*</title><circle[^>]*class="hollow"', drawing
    )
    assert hollow == ['0', '3']
    assert 'No run of the clutch alone that locks once, at this instant, has less.' in page


def test_the_line_of_the_least_falls_and_passes_below_every_run_of_the_clutch_alone(runs) -> None:
    view = front_view(runs, LIMITS.rules)
    assert view is not None
    times, heights = zip(*view.line, strict=True)
    assert list(times) == sorted(times)
    assert list(heights) == sorted(heights, reverse=True)
    _, ls8, sampled, _ = view.runs
    at_locks = [dict(view.line)[point.x] for point in (ls8, sampled)]
    assert max(ls8.x, sampled.x) < times[-1] - 0.1
    assert ls8.y > at_locks[0]
    assert sampled.y > at_locks[1]
    text = r'final lock 1.121 s after control start, 11.27 m/s³, least (.*) m/s³'
    least = re.fullmatch(text, ls8.text)
    assert least is not None
    assert float(least[1]) == pytest.approx(LEAST, rel=LESS)


def test_on_the_logarithmic_scale_the_distance_from_the_least_is_the_ratio(runs) -> None:
    view = front_view(runs, LIMITS.rules)
    assert view is not None
    ticks = {float(text): share for text, share in view.up}
    decade = ticks[50.0] - ticks[5.0]
    for point in view.runs:
        ratio = runs[point.index].scores.metrics['peak_jerk_over_least']
        distance = point.y - dict(view.line)[point.x]
        assert 10.0 ** (distance / decade) == pytest.approx(ratio, rel=3e-3)


def test_without_a_least_there_is_no_drawing() -> None:
    runs = runs_of('ls8', floors=False)
    assert front_view(runs, LIMITS.rules) is None
    assert '<svg class="floor-front"' not in report_page(runs, evidence_of(runs), LIMITS)
