# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Attained value of a metric: requests near its bound that lock cleanly, and their replay."""

import math
from dataclasses import dataclass

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.bound import Bound
from ddct_bringup.floor.case import Case, gives_demand
from ddct_bringup.floor.dynamics.start import driving_acceleration
from ddct_bringup.floor.lock import lock_of
from ddct_bringup.floor.objectives import Objective, Peak, RootMeanSquare, Signals, window_of
from ddct_bringup.floor.program import LinearProgram
from ddct_bringup.floor.replay import replayed, usual_requests
from ddct_bringup.floor.solver import best_point, least_squares
from ddct_plant.scenario.scenario import Scenario

CLEAR_RAD_S = 3.0
"""Slip in rad/s that a run keeps until shortly before its lock, so that it does not lock early."""
CLOSING_RAD_S2 = 50.0
"""Rate in rad/s^2 at which the slip then goes to zero: with less the plates would part again."""
LATEST_S = 0.01
"""Largest distance in s of the lock of a run from the instant of the floor."""
_SMOOTH = 1e-2
"""Share of the bound that may be given away for requests near the usual ones."""
_QUADRATIC = 1e-3
"""Curvature that keeps the requests of a quadratic program near the usual ones."""
_AT_LOCK = 3
"""Number of last requests, which act after the lock too."""
_LEAST_SHARE, _MORE_SHARE = 0.9, 0.1
"""Least ratio of these requests to the usual ones, and its increase after each failed replay."""
_ROUNDS = 6
"""Number of replays, each with the engine, load and kiss point of the one before."""
_NEAR = 2e-3
"""Difference of prediction and replay, relative, below which no further replay is needed."""


@dataclass(frozen=True, eq=False)
class Attained:
    """A run of the simulated plant near the bound."""

    value: float
    """Metric of the run."""
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
    mapped = objective.of(signals)
    columns = case.motion.columns
    if mapped is None or bound.point is None or not columns.requests:
        return Replays(None, None)
    rows = np.ascontiguousarray(mapped.T)
    fixed = np.concatenate([[1.0], (columns.low + columns.high) / 2.0])
    whole = case.settings.scenario.steps
    if begin is not None and begin.steps == whole:
        fixed = case.point_of(begin)
    best, last, before, failed = None, begin, math.inf, 0
    for _ in range(_ROUNDS):
        requests = _requests(case, objective, signals, rows, fixed, bound, failed)
        if requests is None:
            break
        last = run = replayed(case, requests)
        if run.steps < whole:
            break
        predicted = fixed.copy()
        predicted[1 : 1 + columns.requests] = requests
        value = objective.value(
            signals_of_run(case.start.step, signals.engagements_a_day, case.settings.scenario, run)
        )
        lock = lock_of(run, case.start.step)
        late_s = math.inf if lock is None else lock.time_s - case.lock.time_s
        # A linear clutch may be within its band earlier.
        locks = abs(late_s) <= LATEST_S or (not case.settings.stick_slip and late_s <= LATEST_S)
        if not case.limited and not gives_demand(run, case.start.step):
            break
        # The mean, as the next replay would otherwise go as far to the other side.
        fixed = (fixed + case.point_of(run)) / 2.0
        if not locks or value is None:
            failed += 1
            continue
        result = Attained(value, _predicted(objective, signals, predicted), run)
        if best is None or result.value < best.value:
            best = result
        # A further replay helps only while the plant still moves away from the prediction.
        settled = abs(result.value - before) <= _NEAR * abs(result.value)
        before = result.value
        if settled or abs(result.value - result.predicted) <= _NEAR * abs(result.value):
            break
    return Replays(best, last)


def signals_of_run(
    start: int, engagements_a_day: float, scenario: Scenario, run: Trajectory
) -> Signals:
    """Return the signals of a run, whose control starts at step `start`."""
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
        engagements_a_day,
    )


def _predicted(objective: Objective, signals: Signals, point: np.ndarray) -> float:
    """Return the metric that the program predicts for a point, (columns,)."""
    rows = Signals(
        point @ signals.acceleration,
        point @ signals.torsion_speed,
        point @ signals.driving,
        None if signals.slip_acceleration is None else point @ signals.slip_acceleration,
        signals.start,
        signals.window,
        signals.engagements_a_day,
    )
    value = objective.value(rows)
    assert value is not None
    return value


def _requests(
    case: Case,
    objective: Objective,
    signals: Signals,
    rows: np.ndarray,
    fixed: np.ndarray,
    bound: Bound,
    failed: int,
) -> np.ndarray | None:
    """
    Return requests (n,) in N m that lock cleanly, with a metric near the bound.

    Each replay that has failed makes them keep farther away from zero slip, and closer after it.
    """
    count = case.motion.columns.requests
    if not case.settings.stick_slip:
        assert bound.point is not None
        return bound.point[1 : 1 + count]
    used = slice(1, 1 + count)
    limiting, limits = _clean(case, CLEAR_RAD_S * (1 + failed))
    shift = fixed.copy()
    shift[used] = 0.0
    limits = limits - limiting @ shift
    centre = usual_requests(case)[:count]
    low = np.zeros(count)
    low[-_AT_LOCK:] = (_LEAST_SHARE + _MORE_SHARE * failed) * centre[-_AT_LOCK:]
    equations = case.equations
    if isinstance(objective, Peak):
        return _near_peak(
            rows[:, used],
            rows @ shift,
            limiting[:, used],
            limits,
            equations[:, used],
            -equations @ shift,
            centre,
            case.most_request,
            bound,
            case.deferred[: len(limits) - 1],
            low,
        )
    if objective.sliding:
        rows = _strongest(rows, objective, signals, bound)
    weighted = np.sqrt(objective.weights(signals))[:, np.newaxis] * rows
    return least_squares(
        weighted[:, used],
        weighted @ shift,
        low,
        np.full(count, case.most_request),
        limiting[:, used],
        limits,
        equations[:, used],
        -equations @ shift,
        centre,
        _QUADRATIC,
    )


def _strongest(
    rows: np.ndarray, objective: RootMeanSquare, signals: Signals, bound: Bound
) -> np.ndarray:
    """Return the rows of the stretch in which the point of the bound has the largest r.m.s."""
    length = len(objective.weights(signals))
    squares = np.cumsum(np.concatenate([[0.0], (rows @ bound.point) ** 2]))
    first = int(np.argmax(squares[length:] - squares[:-length]))
    return rows[first : first + length]


def _clean(case: Case, least_slip: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the rows and limits of the case with a slip of `least_slip` in rad/s before."""
    rows, limits = case.clutch_limits
    motion = case.motion
    count = len(motion.slip)
    left_s = case.lock.time_s - 0.01 * np.arange(1, count + 1)
    clear = np.minimum(least_slip, CLOSING_RAD_S2 * left_s)
    limits = limits.copy()
    limits[:count] -= np.minimum(clear, 0.5 * abs(case.start.slip))
    assert motion.slip_acceleration is not None
    closing = motion.sign * motion.slip_acceleration
    return np.vstack([rows, closing]), np.append(limits, -CLOSING_RAD_S2)


def _near_peak(
    rows: np.ndarray,
    offset: np.ndarray,
    limiting: np.ndarray,
    limits: np.ndarray,
    equations: np.ndarray,
    values: np.ndarray,
    centre: np.ndarray,
    most: float,
    bound: Bound,
    later: np.ndarray,
    low: np.ndarray,
) -> np.ndarray | None:
    """
    Return requests with the least peak |rows u + offset|, close to `centre`.

    The distance to the centre costs a little: programs choose extreme values for requests that
    hardly matter, and those would open the clutch after the lock.
    """
    count = rows.shape[1]
    if not count:
        return None
    distance = np.abs(centre).max() + 1.0
    price = _SMOOTH * max(bound.value or 0.0, 1e-3) / distance
    one, none = np.ones((len(rows), 1)), np.zeros((len(rows), 1))
    identity, ones = np.eye(count), np.ones((count, 1))
    program = LinearProgram(
        cost=np.concatenate([np.zeros(count), [1.0, price]]),
        constant=0.0,
        rows=np.block(
            [
                [rows, -one, none],
                [-rows, -one, none],
                [identity, 0.0 * ones, -ones],
                [-identity, 0.0 * ones, -ones],
                [limiting, np.zeros((len(limiting), 2))],
            ]
        ),
        limits=np.concatenate([-offset, offset, centre, -centre, limits]),
        equal_rows=np.hstack([equations, np.zeros((len(equations), 2))]),
        equal_values=values,
        low=np.concatenate([low, np.zeros(2)]),
        high=np.concatenate([np.full(count, most), [1e6, 1e6]]),
    )
    deferred = np.zeros(len(program.limits), dtype=bool)
    deferred[2 * len(rows) + 2 * count : -1] = later
    kept = np.zeros(count + 2, dtype=bool)
    point = best_point(program, kept, np.zeros(count + 2), deferred)
    return None if point is None else point[:count]
