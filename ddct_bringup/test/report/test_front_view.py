# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""The report draws the least peak jerk over the lock time, with every run that has a least."""

from itertools import pairwise

import numpy as np
import pytest
from drawn_charts import leave_out_time_charts

from ddct_bringup.documents.chart import Line, Marks
from ddct_bringup.report.evidence import evidence_of
from ddct_bringup.report.front_view import front_view
from ddct_bringup.report.page import report_page
from ddct_bringup.report.page_runs import page_runs
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


@pytest.fixture(autouse=True)
def no_time_charts(monkeypatch: pytest.MonkeyPatch) -> None:
    leave_out_time_charts(monkeypatch)


@pytest.fixture(scope='module')
def runs() -> list[ScoredRecording]:
    """Return a run that slips again, two of the clutch alone, and one that commands the engine."""
    return runs_of('hinf2', 'ls8', 'hinf_sampled', 'torque_estimator')


def test_every_run_is_on_the_front_and_hollow_where_the_least_is_no_bound(runs) -> None:
    view = front_view(runs, LIMITS.rules)
    assert view is not None
    bounds = {index: point.bound for index, point in view.runs.items()}
    assert bounds == {0: False, 1: True, 2: True, 3: False}
    chart = view.chart(page_runs(runs))
    (panel,) = chart.panels
    marks = [each for each in panel.items if isinstance(each, Marks)]
    assert [each.filled for each in marks] == list(bounds.values())
    assert [each.label for each in marks] == ['hinf2', 'ls8', 'hinf_sampled', 'torque_estimator']
    assert panel.y.logarithmic
    page = report_page(runs, evidence_of(runs), LIMITS)
    assert 'No run of the clutch alone that locks once, at this instant, has less.' in page
    assert 'Hollow: the least is a yardstick, not a bound.' in page


def test_the_line_of_the_least_falls_and_passes_below_every_run_of_the_clutch_alone(runs) -> None:
    view = front_view(runs, LIMITS.rules)
    assert view is not None
    times, leasts = zip(*view.line, strict=True)
    assert list(times) == sorted(times)
    assert all(later <= (1.0 + LESS) * least for least, later in pairwise(leasts))
    ls8, sampled = view.runs[1], view.runs[2]
    for point in (ls8, sampled):
        assert dict(view.line)[point.lock_time_s] == point.least < point.value
        assert point.lock_time_s < times[-1]
    assert ls8.lock_time_s == pytest.approx(1.121, abs=5e-4)
    assert ls8.value == pytest.approx(11.27, abs=5e-3)
    assert ls8.least == pytest.approx(LEAST, rel=LESS)
    assert view.counted_from == 'control start'


def test_the_chart_has_the_least_and_every_run_within_its_axes(runs) -> None:
    view = front_view(runs, LIMITS.rules)
    assert view is not None
    (panel,) = view.chart(page_runs(runs)).panels
    assert panel.x.span is not None
    assert panel.y.span is not None
    for item in panel.items:
        heights = item.y if isinstance(item, (Line, Marks)) else np.empty(0)
        assert all(panel.y.span[0] < each < panel.y.span[1] for each in heights)
    times = [time for time, _ in view.line]
    assert panel.x.span[0] == 0.0 < max(times) < panel.x.span[1]
    for index, point in view.runs.items():
        ratio = runs[index].scores.metrics['peak_jerk_over_least']
        assert point.value / point.least == pytest.approx(ratio)


def test_without_a_least_there_is_no_drawing() -> None:
    runs = runs_of('ls8', floors=False)
    assert front_view(runs, LIMITS.rules) is None
    assert 'id="floor-front"' not in report_page(runs, evidence_of(runs), LIMITS)
