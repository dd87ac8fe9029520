# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Floors beside the scores of a run: the share of the drive apart from that of the controller."""

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import replace

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.any_lock import least_at_any_lock
from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.dynamics.start import Start
from ddct_bringup.floor.floor import floors_of_run
from ddct_bringup.floor.values import METRICS, OF_STICK_SLIP, OverFloor, engagements_a_day
from ddct_bringup.run.options import metrics_of
from ddct_bringup.scores.scored_recording import ScoredRecording
from ddct_bringup.scores.scored_run import ScoredRun
from ddct_bringup.verdict.limits import Limits
from ddct_bringup.verdict.state import SUCCESSES
from ddct_bringup.verdict.verdict import (
    BEYOND,
    CriterionFloor,
    CriterionResult,
    verdict_with_floors,
)
from ddct_plant.base.errors import DdctError
from ddct_plant.base.timebase import steps_in
from ddct_plant.scenario.settings import RunSettings

USUAL, ALL, NONE = 'usual', 'all', 'none'
_USUAL = ('peak_jerk', 'peak_acceleration')
"""Metrics whose floors are computed by default, besides criteria that are beyond their limit."""
_DOSE = 'daily_vibration_dose'
_MOST_PERIODS = 500
"""
Largest number of periods after control start whose floors are computed with a score.

The program grows with each period: twice as many take about five times as long.
"""
_NOT_ONCE = 'it does not lock once and stay locked, or it commands the engine'


def add_floors_option(parser: argparse.ArgumentParser, default: str = USUAL) -> None:
    """Add the option --floors to a parser; its value is an argument of `floor_metrics`."""
    parser.add_argument(
        '--floors',
        default=default,
        metavar='A,B,...|usual|all|none',
        help='metrics to compare with the least that any controller could do, see '
        f'docs/use/limit.md; usual: {", ".join(_USUAL)}, and what is beyond a limit; '
        'default: %(default)s',
    )


def floor_metrics(text: str) -> tuple[str, ...] | None:
    """
    Return the metrics in the value of --floors, None for no floors.

    Raise ParameterError for an unknown name.
    """
    if text == NONE:
        return None
    if text in (USUAL, ALL):
        return _USUAL if text == USUAL else tuple(METRICS)
    return tuple(metrics_of('--floors', text, METRICS, 'name a metric, usual, all or none'))


def with_floors(
    run: ScoredRecording, metrics: Sequence[str] | None, limits: Limits
) -> ScoredRecording:
    """
    Return a scored recording with the floors of these metrics, and of criteria beyond limits.

    It is unchanged for None, and where the run failed or has no scenario. `limits` judged it.
    """
    if metrics is None or run.recording is None or run.settings is None:
        return run
    trajectory = run.recording.trajectory
    return replace(
        run, scores=scores_with_floors(run.scores, run.settings, trajectory, metrics, limits)
    )


def scores_with_floors(
    scores: ScoredRun,
    settings: RunSettings,
    trajectory: Trajectory,
    metrics: Sequence[str],
    limits: Limits,
) -> ScoredRun:
    """Return the scores of a run with the floors of metrics and of criteria beyond limits."""
    if not scores.valid or scores.verdict.state not in SUCCESSES:
        return scores
    beyond = {
        each.name: each
        for each in scores.verdict.results
        if each.state == BEYOND and each.name in METRICS
    }
    names = [
        name
        for name in dict.fromkeys((*metrics, *beyond))
        if (settings.stick_slip or name != OF_STICK_SLIP)
        # Only the floor by the packaged rules is computed.
        and (name != _DOSE or limits.rules.engagements_a_day == engagements_a_day())
    ]
    control_start_s = settings.scenario.control_start_s
    periods = settings.scenario.steps - steps_in('control_start_s', control_start_s)
    if periods > _MOST_PERIODS:
        reason = (
            f'{periods} periods after control start: with a score a floor is computed for up to '
            f'{_MOST_PERIODS}, use ddct limit'
        )
        return replace(scores, over_floor=dict.fromkeys(names), no_floor=reason)
    try:
        start = control_start(settings)
        found = floors_of_run(settings, names, trajectory, start, attain=False)
        floors = _criterion_floors(settings, start, found, beyond)
    except DdctError as error:
        return replace(scores, over_floor=dict.fromkeys(names), no_floor=str(error))
    return replace(
        scores,
        verdict=verdict_with_floors(scores.verdict, floors),
        over_floor={name: over.over_floor if over else None for name, over in found.items()},
        no_floor='' if any(found.values()) else _NOT_ONCE,
    )


def scores_with_ratios(
    scores: ScoredRun, settings: RunSettings, trajectory: Trajectory, metrics: Sequence[str]
) -> ScoredRun:
    """
    Return the scores of a run with metrics over their least at the run's own lock time.

    The verdict stays as it is. None for a failed run, and for a metric that it does not have.
    """
    ratios: dict[str, float | None] = dict.fromkeys(metrics)
    names = [name for name in metrics if settings.stick_slip or name != OF_STICK_SLIP]
    if not scores.valid or scores.verdict.state not in SUCCESSES:
        return replace(scores, over_floor=ratios)
    try:
        found = floors_of_run(settings, names, trajectory, attain=False)
    except DdctError as error:
        return replace(scores, over_floor=ratios, no_floor=str(error))
    ratios.update((name, over.over_floor if over else None) for name, over in found.items())
    return replace(scores, over_floor=ratios)


def _criterion_floors(
    settings: RunSettings,
    start: Start,
    found: Mapping[str, OverFloor | None],
    beyond: Mapping[str, CriterionResult],
) -> dict[str, CriterionFloor]:
    """Return the floors of criteria by name; those of runs outside of all floors have none."""
    floors = {}
    for name, over in found.items():
        if over is None:
            continue
        lowest = None
        result = beyond.get(name)
        if result is not None and result.limit is not None:
            lowest = least_at_any_lock(settings, name, start, result.limit)
        floors[name] = CriterionFloor(
            over.floor.least, over.over_floor, lowest.least if lowest else None
        )
    return floors
