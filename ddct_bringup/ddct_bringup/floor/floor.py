# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Floor of a metric: the least that any run can have, proven, beside what a run attains."""

import math
from collections.abc import Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from typing import Any

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.case import Case, case_at, case_of_run
from ddct_bringup.floor.computed_floor import ComputedFloor, computed_floor, floor_without_run
from ddct_bringup.floor.control_start import control_start
from ddct_bringup.floor.coverage import require_not_below
from ddct_bringup.floor.dynamics.start import Start
from ddct_bringup.floor.lock import lock_of
from ddct_bringup.floor.metric_units import FRICTION
from ddct_bringup.floor.values import Floor, OverFloor, Proof, value_of
from ddct_bringup.verdict.limits import packaged_limits
from ddct_plant.base.errors import ParameterError
from ddct_plant.program.arithmetic import limit_threads, named_threads
from ddct_plant.scenario.settings import RunSettings


def floor_of(
    settings: RunSettings, metric: str, lock_time_s: float, start: Start | None = None
) -> Floor:
    """
    Return the floor of a metric for runs that lock `lock_time_s` after control start.

    Runs in which the engine always gives the demand come first: their floor is the sharper one.
    Where runs may do better in which the limits of the engine act, C_m is a variable. Raise
    ParameterError for an unknown metric, or a case without floors.
    """
    start = control_start(settings) if start is None else start
    return floors_at(settings, [metric], lock_time_s, start)[0]


def floors_at(
    settings: RunSettings, metrics: Sequence[str], lock_time_s: float, start: Start
) -> list[Floor]:
    """Return the floors of metrics for runs with one lock instant, as `floor_of` does."""
    latest = (settings.scenario.steps - start.step) / 100.0
    if not 0.0 < lock_time_s < latest:
        raise ParameterError(
            f'lock time {lock_time_s:g} s: give one between 0 and {latest:g} s, when the run ends'
        )
    narrow = case_at(settings, start, lock_time_s, limited=False)
    wide = replace(narrow, limited=True)
    proofs: dict[bool, Proof] = {}

    def floor(metric: str) -> Floor:
        found = _found(narrow, metric, proofs)
        if not found.limited:
            return found.floor
        return _with_attained(_found(wide, metric, proofs, found.last).floor, found.floor)

    with _few_threads():
        return [floor(metric) for metric in metrics]


def _few_threads() -> AbstractContextManager[Any]:
    """Let a process compute floors with the named threads: more take several times as long."""
    return limit_threads(named_threads())


def _found(
    case: Case, metric: str, proofs: dict[bool, Proof], begin: Trajectory | None = None
) -> ComputedFloor:
    """
    Return the floor of a case, and add to `proofs` the proof that the case has no run.

    The proof is the same for every metric but the friction work, whose bound needs no run.
    """
    proof = proofs.get(case.limited)
    if proof is not None and metric != FRICTION:
        return floor_without_run(case, metric, proof)
    found = computed_floor(case, metric, begin)
    if found.floor.least is None:
        proofs[case.limited] = found.floor.certificate
    return found


def _with_attained(floor: Floor, other: Floor) -> Floor:
    """Return a floor with the attained value of another one of fewer runs, where that is less."""
    if other.attained is None or (floor.attained or math.inf) <= other.attained:
        return floor
    return replace(floor, attained=other.attained, replay_residual=other.replay_residual)


def floors_of_run(
    settings: RunSettings,
    metrics: Sequence[str],
    run: Trajectory,
    start: Start | None = None,
) -> dict[str, OverFloor | None]:
    """
    Return by metric the value of a run and the least at its own lock instant.

    The program contains the run; no run near the least is searched for. None where a metric has no
    value, and for all metrics of a run that does not lock once and stay locked, or that
    `why_outside` names. Raise FloorWithdrawnError for a run of the program below its floor.
    """
    none: dict[str, OverFloor | None] = dict.fromkeys(metrics)
    start = control_start(settings) if start is None else start
    rules = packaged_limits().rules
    lock = lock_of(run, start.step, rules)
    if lock is None or run.steps < settings.scenario.steps:
        return none
    case = case_of_run(settings, start, lock, run)
    if case is None:
        return none
    values = {metric: value_of(settings, metric, run, start.scored_from) for metric in metrics}
    return {
        metric: None if value is None else _over(case, metric, value)
        for metric, value in values.items()
    }


def _over(case: Case, metric: str, value: float) -> OverFloor:
    """Return the value of a run of a case beside its floor; raise FloorWithdrawnError below it."""
    floor = floor_of_case(case, metric)
    require_not_below(metric, value, floor.least, case.lock)
    return OverFloor(value, floor)


def floor_of_case(case: Case, metric: str) -> Floor:
    """Return the floor of a metric for the runs of a case, without a run near it."""
    with _few_threads():
        return computed_floor(case, metric, attain=False).floor
