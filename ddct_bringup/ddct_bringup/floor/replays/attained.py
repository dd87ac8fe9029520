# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Attained values: requests near the bound that lock cleanly, and their replay in the plant."""

import math
from dataclasses import dataclass, replace

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.bound import Bound
from ddct_bringup.floor.case import Case
from ddct_bringup.floor.coverage import cut_step
from ddct_bringup.floor.dynamics.engine_laws import law_of_run
from ddct_bringup.floor.dynamics.laws import load_of_run
from ddct_bringup.floor.dynamics.start import driving_acceleration
from ddct_bringup.floor.dynamics.torque_cut import gives_demand
from ddct_bringup.floor.lock import lock_of
from ddct_bringup.floor.objectives import Objective, Signals, window_of
from ddct_bringup.floor.point import point_of
from ddct_bringup.floor.replays.replay import replayed, usual_requests
from ddct_bringup.floor.replays.requests import requests_near
from ddct_plant.scenario.scenario import Scenario

LATEST_S = 0.01
"""Largest distance of the lock of a run from the instant of the floor in s."""
_ROUNDS = 3
"""Number of replays, each with the engine, load and kiss point of the one before."""
_FAILURES = 1
"""Number of replays that may fail to lock as the bound has it."""
_NEAR = 5e-3
"""Difference of prediction and replay, relative, below which no further replay is needed."""


@dataclass(frozen=True, eq=False)
class Attained:
    """A run of the simulated plant near the bound."""

    value: float
    """Its metric."""
    predicted: float
    """Metric that the program predicts for it."""
    run: Trajectory


@dataclass(frozen=True, eq=False)
class Replays:
    """Replays of a bound in the simulated plant."""

    best: Attained | None
    """Replay with the least metric among those that lock as the bound has it; None without one."""
    last: Trajectory | None
    """Last replay, whether it locks or not; None without requests to replay."""


def replays_of(
    case: Case,
    objective: Objective,
    signals: Signals,
    bound: Bound,
    begin: Trajectory | None = None,
) -> Replays:
    """
    Return the replays of a bound, up to one in which the engine leaves the case.

    What load, engine and capacity leave over is that of the replay before, at first that of the
    run `begin`. Whatever the requests are, a replay is a run: its metric can be attained.
    """
    if bound.point is None or not case.motion.columns.requests:
        return Replays(None, None)
    whole = case.settings.scenario.steps
    columns = case.motion.columns
    near, fixed = case, np.concatenate([[1.0], (columns.low + columns.high) / 2.0])
    best, last, before, failed, needed = None, begin, math.inf, 0, None
    if last is None and (case.limited or case.start.off_going):
        last = replayed(case, usual_requests(case)[: columns.requests])
    if last is not None and last.steps == whole:
        near = _near(case, last)
        fixed = point_of(near, last)
    for _ in range(_ROUNDS):
        if near is not case:
            signals = Signals.of_motion(near.motion, case.settings.scenario)
        requests, needed = requests_near(near, objective, signals, fixed, bound, failed, needed)
        if requests is None:
            break
        last = run = replayed(case, requests)
        if run.steps < whole:
            break
        predicted = fixed.copy()
        predicted[1 : 1 + columns.requests] = requests
        value = objective.value(
            signals_of_run(case.start.scored_from, case.settings.scenario, run)
        )
        locks = _locks(case, run)
        if cut_step(case.settings, run, case.start.step) is not None:
            break
        if not case.limited and not gives_demand(run, case.start.step):
            break
        if not locks or value is None:
            failed += 1
            if failed > _FAILURES:
                break
        else:
            result = Attained(value, _predicted(objective, signals, predicted), run)
            if best is None or result.value < best.value:
                best = result
            # A further replay helps only while the plant still moves away from the prediction.
            settled = abs(result.value - before) <= _NEAR * abs(result.value)
            before = result.value
            if settled or abs(result.value - result.predicted) <= _NEAR * abs(result.value):
                break
        near = _near(case, run)
        now = point_of(near, run)
        # The mean, as the next replay would otherwise go as far to the other side.
        fixed = (fixed + now) / 2.0 if len(fixed) == len(now) else now
    return Replays(best, last)


def _near(case: Case, run: Trajectory) -> Case:
    """Return the case with engine and load near a run."""
    start = case.start.step
    laws = (law_of_run(case.settings, run, start), load_of_run(case.settings, run, start))
    return replace(case, near_run=laws)


def _locks(case: Case, run: Trajectory) -> bool:
    """Return whether a run locks as the case has it; a linear clutch may be in its band before."""
    lock = lock_of(run, case.start.step, case.rules)
    late_s = math.inf if lock is None else lock.time_s - case.lock.time_s
    return abs(late_s) <= LATEST_S or (not case.settings.stick_slip and late_s <= LATEST_S)


def signals_of_run(start: int, scenario: Scenario, run: Trajectory) -> Signals:
    """Return the signals of a run whose metrics count from step `start`."""
    slopes = [
        event.slip_acceleration
        for events in (run.phase_events or ())[start + 1 :]
        for event in events
    ]
    return Signals(
        run.vehicle_accel,
        run.driveshaft_speed,
        driving_acceleration(scenario, run.driveshaft_effort),
        np.array(slopes[:1]) if slopes else None,
        start,
        window_of(scenario),
    )


def _predicted(objective: Objective, signals: Signals, point: np.ndarray) -> float:
    """Return the metric that the program predicts for a point, (columns,)."""
    rows = replace(
        signals,
        acceleration=point @ signals.acceleration,
        torsion_speed=point @ signals.torsion_speed,
        driving=point @ signals.driving,
        slip_acceleration=None
        if signals.slip_acceleration is None
        else point @ signals.slip_acceleration,
    )
    value = objective.value(rows)
    assert value is not None
    return value
