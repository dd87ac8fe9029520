# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Floors over a grid of lock times, least lock times under a cap, and runs beside them."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ddct_bringup.floor.coverage import why_outside
from ddct_bringup.floor.dynamics.start import Start
from ddct_bringup.floor.floor import floors_at, floors_of_run
from ddct_bringup.floor.lock import lock_of
from ddct_bringup.floor.objectives import window_of
from ddct_bringup.floor.values import Floor, OverFloor, Proof, value_of
from ddct_bringup.many_runs.engine import each_result
from ddct_bringup.run.headless import run_headless
from ddct_bringup.verdict.limits import packaged_limits
from ddct_controllers.registry import Chosen, controller_label
from ddct_plant.scenario.settings import RunSettings

POINTS = 15
"""Number of lock times of a front."""
_SHARES = (0.35, 0.95)
"""First and last lock time as shares of the time from control start to the end of the window."""


def usual_lock_times(settings: RunSettings, start: Start) -> list[float]:
    """Return lock times in s from control start, multiples of 10 ms, to the score window's end."""
    span = window_of(settings.scenario)[1] - start.step
    steps = np.unique(np.round(np.linspace(*_SHARES, POINTS) * span)).astype(int)
    return [int(step) / 100.0 for step in steps if step > 0]


def front(
    settings: RunSettings,
    metrics: Sequence[str],
    lock_times_s: Sequence[float],
    start: Start,
    workers: int | None = None,
) -> Iterator[list[Floor]]:
    """
    Yield the floors of all metrics for each lock time.

    They are computed by `workers` processes, by default one per core.
    """

    def point(time_s: float) -> list[Floor]:
        return floors_at(settings, metrics, time_s, start)

    return each_result(point, lock_times_s, workers)


@dataclass(frozen=True)
class FloorRow:
    """A floor under the keys of `limit --json`."""

    lock_time_s: float
    metric: str
    least: float | None
    attained: float | None
    gap: float | None
    certificate: Proof
    replay_residual: float | None


@dataclass(frozen=True)
class LeastLockTime:
    """Least lock time under a cap, under the keys of `limit --json`."""

    metric: str
    cap: float
    lock_time_s: float | None
    excluded_before_s: float | None


@dataclass(frozen=True)
class ControllerRow:
    """A metric of a controller's run beside its least, under the keys of `limit --json`."""

    controller: str
    metric: str
    lock_time_s: float | None
    value: float | None
    least: float | None
    over_floor: float | None
    certificate: Proof | None
    outside: str
    """Why the run is none of those of a floor; empty where it is one."""


@dataclass(frozen=True)
class LimitDocument:
    """Document of `limit --json`."""

    front: list[FloorRow]
    controllers: list[ControllerRow]
    least_lock_times: list[LeastLockTime]


def floor_row(floor: Floor) -> FloorRow:
    """Return the row of a floor."""
    return FloorRow(
        lock_time_s=floor.lock_time_s,
        metric=floor.metric,
        least=floor.least,
        attained=floor.attained,
        gap=floor.gap,
        certificate=floor.certificate,
        replay_residual=floor.replay_residual,
    )


def least_lock_time(floors: Sequence[Floor], metric: str, cap: float) -> LeastLockTime:
    """
    Return the least lock time of a front at which a metric can be at most `cap`.

    Each instant is decided for itself, as a longer time need not be easier. `lock_time_s` is the
    first that a run attains, None without one; `excluded_before_s` the last of the instants before
    which are all proven impossible.
    """
    own = sorted((f for f in floors if f.metric == metric), key=lambda f: f.lock_time_s)
    attained = [f.lock_time_s for f in own if f.attained is not None and f.attained <= cap]
    possible = [f.lock_time_s for f in own if f.least is not None and f.least <= cap]
    return LeastLockTime(
        metric=metric,
        cap=cap,
        lock_time_s=attained[0] if attained else None,
        excluded_before_s=possible[0] if possible else None,
    )


def controller_rows(
    settings: RunSettings, controller: Chosen, metrics: Sequence[str], start: Start
) -> list[ControllerRow]:
    """
    Return a row for each metric of a controller's run, under the keys of `limit --json`.

    Least and ratio are None where the run is none of those of a floor.
    """
    run, rules = run_headless(settings, controller), packaged_limits().rules
    lock = lock_of(run, start.step, rules)
    over: Mapping[str, OverFloor | None] = floors_of_run(settings, metrics, run, start)
    rows: list[ControllerRow] = []
    for metric in metrics:
        found = over[metric]
        whole = run.steps == settings.scenario.steps
        value = value_of(settings, metric, run, start.scored_from) if whole else None
        rows.append(
            ControllerRow(
                controller=controller_label(controller),
                metric=metric,
                lock_time_s=lock.time_s if lock else None,
                value=found.value if found else value,
                least=found.floor.least if found else None,
                over_floor=found.over_floor if found else None,
                certificate=found.floor.certificate if found else None,
                outside=why_outside(settings, start, run, rules),
            )
        )
    return rows
