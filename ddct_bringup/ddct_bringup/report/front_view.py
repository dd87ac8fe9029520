# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Front: the least peak jerk over the time of the lock, with the runs on it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ddct_bringup.floor.computed_floor import LIMITS
from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.dynamics.start import Start
from ddct_bringup.floor.floor import floors_of_run
from ddct_bringup.floor.front import least_values, usual_lock_times
from ddct_bringup.floor.lock import counted_from
from ddct_bringup.floor.values import OverFloor
from ddct_bringup.report.page_parts import value_text
from ddct_bringup.report.pareto import round_numbers
from ddct_bringup.scores.scored_recording import ScoredRecording
from ddct_plant.base.errors import DdctError
from ddct_plant.scenario.settings import RunSettings

METRIC = 'peak_jerk'
"""Metric of the front."""
_POINTS = 8
"""Number of lock times whose least is computed."""
_HEADROOM = 1.1
"""Top of the drawing over the largest value of a run."""


@dataclass(frozen=True)
class FrontPoint:
    """One run on the drawing, in shares of its width and height from the lower left corner."""

    index: int
    """Position in the report."""
    x: float
    y: float
    text: str
    """Lock time, value and least as text."""


@dataclass(frozen=True)
class FrontView:
    """Data of the drawing; places are shares of its width and height, 0 to 1."""

    counted_from: str
    """Words for the instant from which lock times count."""
    covers: str
    """Runs that the least is proven for."""
    line: tuple[tuple[float, float], ...]
    """Points of the least, from the earliest lock time on."""
    runs: tuple[FrontPoint, ...]
    across: tuple[tuple[str, float], ...]
    """Text and place of each tick of the lock time in s."""
    up: tuple[tuple[str, float], ...]
    """Text and place of each tick of the metric."""


def front_view(runs: Sequence[ScoredRecording]) -> FrontView | None:
    """
    Return the drawing for the runs that have a floor, None without one.

    Runs of other settings than the first of them are not on it: another clutch has another front.
    """
    with_floor = [
        index
        for index, run in enumerate(runs)
        if run.settings is not None and run.scores.over_floor.get(METRIC) is not None
    ]
    if not with_floor:
        return None
    settings = runs[with_floor[0]].settings
    assert settings is not None
    try:
        return _drawn(settings, {i: runs[i] for i in with_floor if runs[i].settings == settings})
    except DdctError:
        return None


def _drawn(settings: RunSettings, runs: Mapping[int, ScoredRecording]) -> FrontView | None:
    start = control_start(settings)
    found = {index: over for index, run in runs.items() if (over := _over(settings, start, run))}
    limited = any(over.floor.certificate['covers'] == LIMITS for over in found.values())
    usual = usual_lock_times(settings, start)
    latest = max(over.floor.lock_time_s for over in found.values())
    times = np.round(np.linspace(usual[0], max(usual[-1], latest), _POINTS), 2).tolist()
    floors = [
        floor
        for floor in least_values(settings, METRIC, times, start, limited=limited)
        if floor.least is not None
    ]
    if len(floors) < 2:
        return None
    right = max(times[-1], latest)
    across = (0.0, right + 0.05 * right)
    top = _HEADROOM * max(over.value for over in found.values())
    return FrontView(
        counted_from=counted_from(settings),
        covers=floors[0].certificate['covers'],
        line=tuple(
            (_share(floor.lock_time_s, *across), min(_share(floor.least or 0.0, 0.0, top), 1.0))
            for floor in floors
        ),
        runs=tuple(
            FrontPoint(
                index,
                _share(over.floor.lock_time_s, *across),
                _share(over.value, 0.0, top),
                f'lock {over.floor.lock_time_s:.3f} s after {counted_from(settings)}, '
                f'{value_text(over.value)} m/s³, least {value_text(over.floor.least)} m/s³',
            )
            for index, over in found.items()
        ),
        across=_ticks(*across),
        up=_ticks(0.0, top),
    )


def _over(settings: RunSettings, start: Start, run: ScoredRecording) -> OverFloor | None:
    assert run.recording is not None
    trajectory = run.recording.trajectory
    return floors_of_run(settings, [METRIC], trajectory, start, attain=False)[METRIC]


def _share(value: float, first: float, last: float) -> float:
    return round((value - first) / (last - first), 4)


def _ticks(first: float, last: float) -> tuple[tuple[str, float], ...]:
    return tuple((f'{tick:g}', _share(tick, first, last)) for tick in round_numbers(first, last))
