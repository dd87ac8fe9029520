# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Requests near a bound that a run locks cleanly with: once, and for good."""

from dataclasses import dataclass, replace

import numpy as np

from ddct_bringup.floor.bound import Bound
from ddct_bringup.floor.case import Case
from ddct_bringup.floor.dynamics.engine_laws import demand_law
from ddct_bringup.floor.objectives import Objective, Peak, Signals
from ddct_bringup.floor.program.peak import late_peaks, peak_program
from ddct_bringup.floor.program.quadratic import least_squares
from ddct_bringup.floor.program.solve import best_point
from ddct_bringup.floor.replays.replay import usual_requests

CLEAR_RAD_S = 3.0
"""Slip in rad/s that a run keeps until shortly before its lock, so that it does not lock early."""
CLOSING_RAD_S2, CLOSING_SHARE = 50.0, 0.25
"""Slope of the slip from there to zero: at most this in rad/s^2, and this share of the mean slope.

Slower, and the plates might part again; each replay that has failed adds as much."""
_AWAY = 2.0
"""Largest distance of requests from the usual ones, as a share of the largest of these."""
_QUADRATIC = 1e-3
"""Curvature that keeps the requests of a quadratic program near the usual ones."""
_AT_LOCK = 3
"""Number of last requests, which act after the lock too."""
_AT_START, _BELOW_IDLE = 3, 2.0
"""Number of first steps whose w_m hardly depends on requests, and how far in rad/s the later ones
may be below idle."""
_LEAST_SHARE, _MORE_SHARE = 0.9, 0.1
"""Least share of the usual ones that these are, and how much more after each failed replay."""


@dataclass(frozen=True, eq=False)
class _Choice:
    """Requests u, (n,), that may be chosen: rows u <= limits, equations, and a box."""

    rows: np.ndarray
    limits: np.ndarray
    deferred: np.ndarray
    equal_rows: np.ndarray
    equal_values: np.ndarray
    low: np.ndarray
    high: np.ndarray
    centre: np.ndarray
    """Usual requests in N m."""


def requests_near(
    case: Case,
    objective: Objective,
    signals: Signals,
    fixed: np.ndarray,
    bound: Bound,
    failed: int,
    needed: np.ndarray | None,
) -> tuple[np.ndarray | None, np.ndarray | None]:
    """
    Return requests (n,) in N m that lock cleanly, with a metric near the bound; None without any.

    `fixed` (columns,) has the values of all other variables. Each replay that has `failed` makes
    the requests keep farther away from zero slip, and closer after it. The second result is the
    mask of the rows that were needed: as `needed` it makes the next call faster.
    """
    count = case.motion.columns.requests
    if not case.settings.stick_slip:
        assert bound.point is not None
        return bound.point[1 : 1 + count], None
    mapped = objective.of(signals)
    assert mapped is not None
    rows = np.ascontiguousarray(mapped.T)
    used = slice(1, 1 + count)
    given = fixed.copy()
    given[used] = 0.0
    choice = _clean(case, given, failed)
    if isinstance(objective, Peak):
        if needed is not None:
            choice = replace(choice, deferred=choice.deferred & ~needed)
        return _least_peak(choice, rows[:, used], rows @ given, case.lock.time_s)
    if objective.samples:
        rows = rows[bound.stretch : bound.stretch + objective.samples]
    weighted = rows / np.sqrt(len(rows))
    best = least_squares(
        weighted[:, used],
        weighted @ given,
        choice.low,
        choice.high,
        choice.rows,
        choice.limits,
        choice.equal_rows,
        choice.equal_values,
        choice.centre,
        _QUADRATIC,
    )
    return None if best is None else best.point, None


def _clean(case: Case, given: np.ndarray, failed: int) -> _Choice:
    """Return the requests that keep some slip before the lock, and go to zero fast at last."""
    motion, limits = case.motion, case.clutch_limits.limits.copy()
    slips, used = len(motion.slip), slice(1, 1 + motion.columns.requests)
    left_s = case.lock.time_s - 0.01 * np.arange(1, slips + 1)
    mean = abs(case.start.slip) / case.lock.time_s
    closing = min(CLOSING_RAD_S2, CLOSING_SHARE * (1 + failed) * mean)
    clear = np.minimum(CLEAR_RAD_S * (1 + failed), closing * left_s)
    limits[:slips] -= np.minimum(clear, 0.5 * abs(case.start.slip))
    assert motion.slip_acceleration is not None
    speed, least = _kept_speed(case)
    rows = np.vstack([case.clutch_limits.rows, motion.sign * motion.slip_acceleration, -speed])
    limits = np.concatenate([limits, [-closing], -least])
    centre = usual_requests(case)[: motion.columns.requests]
    away = _AWAY * float(np.max(centre, initial=0.0))
    low = np.maximum(centre - away, 0.0)
    low[-_AT_LOCK:] = (_LEAST_SHARE + _MORE_SHARE * failed) * centre[-_AT_LOCK:]
    return _Choice(
        rows[:, used],
        limits - rows @ given,
        np.concatenate([case.clutch_limits.deferred, [False], np.ones(len(least), dtype=bool)]),
        case.equations[:, used],
        -case.equations @ given,
        low,
        np.minimum(centre + away, case.most_request),
        centre,
    )


def _kept_speed(case: Case) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the rows of w_m, (n, columns), and what it is kept above in rad/s, (n,).

    Where the engine gives the demand throughout, idle control must not act: it integrates what
    the speed is below idle.
    """
    speed = case.motion.engine_speed[_AT_START:-1]
    limits = case.settings.scenario.engine_limits
    if case.limited or limits is None:
        return speed[:0], np.zeros(0)
    least = demand_law(case.settings, case.start.step, len(case.tube.engine_low)).least_speed
    assert least is not None
    return speed, np.maximum(least[_AT_START:-1], limits.idle_rad_s - _BELOW_IDLE)


def _least_peak(
    choice: _Choice, rows: np.ndarray, offset: np.ndarray, lock_time_s: float
) -> tuple[np.ndarray | None, np.ndarray]:
    """
    Return requests with the least peak |rows u + offset|, and the rows of `choice` it needed.

    Requests that hardly matter are those in the middle of the box, the usual ones.
    """
    program = peak_program(
        rows,
        offset,
        choice.rows,
        choice.limits,
        choice.equal_rows,
        choice.equal_values,
        choice.low,
        choice.high,
    )
    late = late_peaks(len(rows), lock_time_s)
    point, used = best_point(program, np.append(late, choice.deferred))
    return None if point is None else point[:-1], used[len(late) :]
