# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""
Front: the least peak jerk over the time of the lock, with the runs beside it.

The scale of the jerk is logarithmic: the distance of a run from the least is its ratio.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ddct_bringup.documents.page_parts import value_text
from ddct_bringup.floor.case import case_at
from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.dynamics.start import Start
from ddct_bringup.floor.floor import floor_of_case
from ddct_bringup.floor.front import usual_lock_times
from ddct_bringup.floor.lock import counted_from, final_lock_of
from ddct_bringup.metrics.catalogue import JERK_OVER_LEAST
from ddct_bringup.report.pareto import round_numbers
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


@dataclass(frozen=True)
class FrontPoint:
    """One run on the drawing, in shares of its width and height from the lower left corner."""

    index: int
    """Position in the report."""
    x: float
    y: float
    bound: bool
    """Whether the least is a bound for the run."""
    text: str
    """Lock time, value and least as text."""


@dataclass(frozen=True)
class FrontView:
    """Data of the drawing; places are shares of its width and height, 0 to 1."""

    counted_from: str
    """Words for the instant from which lock times count."""
    line: tuple[tuple[float, float], ...]
    """Points of the least, from the earliest lock time on."""
    runs: tuple[FrontPoint, ...]
    across: tuple[tuple[str, float], ...]
    """Text and place of each tick of the lock time in s."""
    up: tuple[tuple[str, float], ...]
    """Text and place of each tick of the peak jerk in m/s^3."""


@dataclass(frozen=True)
class _Placed:
    """Final lock time in s, peak jerk and its least in m/s^3 of one run."""

    lock_time_s: float
    value: float
    least: float
    bound: bool


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


def _placed(run: ScoredRecording, start: Start, rules: Rules) -> _Placed:
    assert run.recording is not None
    lock = final_lock_of(run.recording.trajectory, start.step, rules)
    assert lock is not None, 'without a final lock there is no least'
    value, ratio = (run.scores.metrics[key] for key in ('peak_jerk_m_s3', JERK_OVER_LEAST.key))
    assert value is not None
    assert ratio is not None
    return _Placed(lock.time_s, value, value / ratio, run.scores.least_is_bound is True)


def _drawn(
    settings: RunSettings, start: Start, runs: Mapping[int, _Placed], rules: Rules
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
    right = max(times[-1], latest)
    across = (0.0, right + 0.05 * right)
    up = (
        math.log10(min(leasts.values()) / _HEADROOM),
        math.log10(_HEADROOM * max(run.value for run in runs.values())),
    )
    return FrontView(
        counted_from=counted_from(settings),
        line=tuple(
            (_share(time_s, *across), min(_share(math.log10(leasts[time_s]), *up), 1.0))
            for time_s in sorted(leasts)
        ),
        runs=tuple(
            FrontPoint(
                index,
                _share(run.lock_time_s, *across),
                _share(math.log10(run.value), *up),
                run.bound,
                f'final lock {run.lock_time_s:.3f} s after {counted_from(settings)}, '
                f'{value_text(run.value)} m/s³, least {value_text(run.least)} m/s³',
            )
            for index, run in runs.items()
        ),
        across=tuple((f'{tick:g}', _share(tick, *across)) for tick in round_numbers(*across)),
        up=_logarithmic_ticks(*up),
    )


def _share(value: float, first: float, last: float) -> float:
    return round((value - first) / (last - first), 4)


def _logarithmic_ticks(first: float, last: float) -> tuple[tuple[str, float], ...]:
    """Return 1, 2 and 5 times the powers of ten between two decimal logarithms."""
    powers = range(math.floor(first), math.ceil(last))
    ticks = (factor * 10.0**power for power in powers for factor in (1, 2, 5))
    return tuple(
        (f'{tick:g}', _share(math.log10(tick), first, last))
        for tick in ticks
        if first <= math.log10(tick) <= last
    )
