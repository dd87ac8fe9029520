# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Front: the least peak jerk over the time of the lock, with the runs beside it.

The scale of the jerk is logarithmic: the distance of a run from the least is its ratio.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ddct_bringup.documents.chart import Area, Chart, ChartAxis, Item, Line, Marks, Panel
from ddct_bringup.documents.page_parts import value_text
from ddct_bringup.documents.palette import NEUTRAL, LineLook, point_mark
from ddct_bringup.floor.case import case_at
from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.dynamics.start import Start
from ddct_bringup.floor.floor import floor_of_case
from ddct_bringup.floor.front import usual_lock_times
from ddct_bringup.floor.lock import counted_from, final_lock_of
from ddct_bringup.metrics.catalogue import JERK_OVER_LEAST
from ddct_bringup.report.page_runs import PageRun
from ddct_bringup.scores.floors import PEAK_JERK
from ddct_bringup.scores.scored_recording import ScoredRecording
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.rules import Rules
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.settings import RunSettings

_POINTS = 8
"""Number of lock times whose least is computed besides those of the runs."""
_HEADROOM = 1.2
"""Top of the drawing over the largest value of a run, and least value over its bottom."""
_HEIGHT_PX = 320


@dataclass(frozen=True)
class FrontPoint:
    """Final lock time in s, peak jerk and its least in m/s^3 of one run."""

    lock_time_s: float
    value: float
    least: float
    bound: bool
    """Whether the least is a bound for the run."""


@dataclass(frozen=True)
class FrontView:
    """The least over the lock time, and the runs."""

    counted_from: str
    """Words for the instant from which lock times count."""
    line: tuple[tuple[float, float], ...]
    """Lock times in s and leasts in m/s^3, from the earliest lock time on."""
    runs: Mapping[int, FrontPoint]
    """Runs by their position in the report."""

    def chart(self, runs: Sequence[PageRun]) -> Chart:
        """Return the chart of the least, with a mark for each of the runs of the page."""
        times, leasts = np.array(self.line).T
        lowest = min(leasts) / _HEADROOM
        highest = _HEADROOM * max(point.value for point in self.runs.values())
        items: list[Item] = [
            Area(times, np.full(len(times), lowest), leasts, 'no run of the clutch alone'),
            Line(times, leasts, LineLook(NEUTRAL), 'least'),
        ]
        items += [_mark(runs[index], point) for index, point in self.runs.items()]
        across = ChartAxis(
            f'time from {self.counted_from} to the final lock, s', (0.0, 1.05 * max(times))
        )
        up = ChartAxis('peak jerk, m/s³', (lowest, highest), logarithmic=True)
        return Chart(
            'Peak jerk over the least', (Panel(tuple(items), across, up, '', _HEIGHT_PX),)
        )


def _mark(run: PageRun, point: FrontPoint) -> Marks:
    """Return the mark of a run, hollow where the least is a yardstick."""
    return Marks(
        np.array([point.lock_time_s]),
        np.array([point.value]),
        run.look.colour,
        run.label,
        point_mark(run.index),
        filled=point.bound,
        size=10.0,
        hint=f'{run.label}: {value_text(point.value)} m/s³, least {value_text(point.least)} m/s³',
    )


def front_view(runs: Sequence[ScoredRecording], rules: Rules | None = None) -> FrontView | None:
    """
    Return the drawing for the runs whose peak jerk has a least, None without one.

    Runs of other settings than the first of them are not on it: another clutch has another front.
    `rules` judged the runs; without rules they are the packaged ones.
    """
    with_least = {
        index: run
        for index, run in enumerate(runs)
        if run.settings is not None and run.scores.metrics[JERK_OVER_LEAST.key] is not None
    }
    if not with_least:
        return None
    settings = next(iter(with_least.values())).settings
    assert settings is not None
    rules = rules or packaged_limits().rules
    try:
        start = control_start(settings)
        placed = {
            index: _placed(run, start, rules)
            for index, run in with_least.items()
            if run.settings == settings
        }
        return _drawn(settings, start, placed, rules)
    except DdctError:
        return None


def _placed(run: ScoredRecording, start: Start, rules: Rules) -> FrontPoint:
    assert run.recording is not None
    lock = final_lock_of(run.recording.trajectory, start.step, rules)
    assert lock is not None, 'without a final lock there is no least'
    value, ratio = (run.scores.metrics[key] for key in ('peak_jerk_m_s3', JERK_OVER_LEAST.key))
    assert value is not None
    assert ratio is not None
    return FrontPoint(lock.time_s, value, value / ratio, run.scores.least_is_bound is True)


def _drawn(
    settings: RunSettings, start: Start, runs: Mapping[int, FrontPoint], rules: Rules
) -> FrontView:
    usual = usual_lock_times(settings, start)
    latest = max(run.lock_time_s for run in runs.values())
    times = np.round(np.linspace(usual[0], max(usual[-1], latest), _POINTS), 2).tolist()
    leasts = {run.lock_time_s: run.least for run in runs.values()}
    for time_s in times:
        # As in the runs' own least, the engine gives the demand.
        case = case_at(settings, start, time_s, rules, limited=False)
        least = floor_of_case(case, PEAK_JERK).least
        if least is not None:
            leasts[time_s] = least
    return FrontView(counted_from(settings), tuple(sorted(leasts.items())), runs)
