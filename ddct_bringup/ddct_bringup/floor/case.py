# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Runs that a floor covers: those that start alike and lock at one instant, as rows."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.dynamics.capacity import CapacityRange, capacity_range, stays_within
from ddct_bringup.floor.dynamics.laws import EngineLaw, Law, demand_law, engine_law, load_law
from ddct_bringup.floor.dynamics.motion import Motion, motion_of
from ddct_bringup.floor.dynamics.start import Start
from ddct_bringup.floor.dynamics.tube import Tube, rigid_tube
from ddct_bringup.floor.lock import BAND_RAD_S, Lock
from ddct_plant.scenario.settings import RunSettings

MOST_REQUEST = 2000.0
"""Highest request in N m that a floor covers, unless a compared run requests more."""
_BAND_SHARE = 0.01
"""Share of the band of a linear clutch that points keep clear of."""
_LAST_SLIPS = 10
"""Number of steps before the lock at which the sign of the slip is a limit from the beginning."""


@dataclass(frozen=True, eq=False)
class Case:
    """
    Runs of one scenario from one state at control start that lock once, at one instant.

    The variables, each in an interval, are the requests and the remainders of the laws of engine,
    load and capacity. Every run whose speeds stay in the band is a point.
    """

    settings: RunSettings
    start: Start
    lock: Lock
    tube: Tube
    limited: bool
    """Whether C_m may differ from the demand, as where limits of the engine act."""
    capacity: CapacityRange
    most_request: float = MOST_REQUEST

    @cached_property
    def engine(self) -> EngineLaw:
        """Law of C_m."""
        if self.limited:
            return engine_law(self.settings, self.tube, self.start.step, self.start.idle_integral)
        return demand_law(self.settings, self.start.step, len(self.tube.engine_low))

    @cached_property
    def load(self) -> Law:
        """Law of the torque at the wheel."""
        return load_law(self.settings, self.tube, self.start.step)

    @cached_property
    def motion(self) -> Motion:
        """Signals of the runs as functions of the variables."""
        time_s = self.lock.time_s if self.settings.stick_slip else None
        return motion_of(
            self.settings,
            self.start,
            time_s,
            self.engine,
            self.load,
            self.capacity,
            self.most_request,
        )

    @cached_property
    def inequalities(self) -> tuple[np.ndarray, np.ndarray]:
        """Rows (m, columns) and limits (m,) of the inequalities rows z <= limits of every run."""
        rows, limits = self.clutch_limits
        lines, line_limits = self._engine_lines()
        return np.vstack([rows, lines]), np.concatenate([limits, line_limits])

    @cached_property
    def clutch_limits(self) -> tuple[np.ndarray, np.ndarray]:
        """
        Rows and limits of the slip and the capacity, the first of `inequalities`.

        Plates that stick slip one way until the lock, and their capacity is between zero and its
        most. A linear clutch stays within the band from its lock on.
        """
        motion = self.motion
        if not self.settings.stick_slip:
            after = motion.slip[self.lock.periods - 1 :]
            return np.vstack([after, -after]), np.full(2 * len(after), BAND_RAD_S)
        slip = -motion.sign * motion.slip
        # Node 10 of a period is node 0 of the next.
        torque = motion.capacity[:, :-1].reshape(-1, motion.columns.count)
        rows = [slip, -torque]
        limits = [np.zeros(len(slip) + len(torque))]
        if np.isfinite(self.capacity.most):
            rows.append(torque)
            limits.append(np.full(len(torque), self.capacity.most))
        return np.vstack(rows), np.concatenate(limits)

    def _engine_lines(self) -> tuple[np.ndarray, np.ndarray]:
        """Return rows and limits of the lines over w_m between which the engine torque is."""
        columns, law = self.motion.columns, self.engine
        if columns.engine.stop == columns.engine.start:
            return np.zeros((0, columns.count)), np.zeros(0)
        steps = columns.engine.stop - columns.engine.start
        speed = self.motion.engine_speed[:steps]
        torque = law.slope[:steps, np.newaxis] * speed
        torque[:, 0] += law.offset[:steps]
        torque[np.arange(steps), columns.engine.start + np.arange(steps)] += 1.0
        rows = []
        for offset, slope, side in law.lines:
            beyond = torque - slope[:steps, np.newaxis] * speed
            beyond[:, 0] -= offset[:steps]
            rows.append(side * beyond)
        return np.vstack(rows), np.zeros(steps * len(rows))

    @property
    def margin(self) -> np.ndarray:
        """
        Distance to the inequalities (m,) that makes a point a run of the simulated plant too.

        Only the band of a linear clutch has one: the load is not exactly that of the point.
        """
        _, limits = self.inequalities
        margin = np.zeros(len(limits))
        if not self.settings.stick_slip:
            margin[: 2 * (len(self.motion.slip) - self.lock.periods + 1)] = (
                _BAND_SHARE * BAND_RAD_S
            )
        return margin

    @property
    def deferred(self) -> np.ndarray:
        """Mask of the inequalities that seldom matter, (m,): all but the last slips and a band."""
        _, limits = self.inequalities
        deferred = np.ones(len(limits), dtype=bool)
        slips = len(self.motion.slip)
        if self.settings.stick_slip:
            deferred[max(slips - _LAST_SLIPS, 0) : slips] = False
        else:
            deferred[: 2 * (slips - self.lock.periods + 1)] = False
        return deferred

    @cached_property
    def equations(self) -> np.ndarray:
        """Rows (p, columns) that are zero in every run: the slip at the instant of the lock."""
        slip = self.motion.slip_at_lock
        return np.zeros((0, self.motion.columns.count)) if slip is None else slip[np.newaxis]

    def point_of(self, run: Trajectory) -> np.ndarray:
        """Return a run as a point of the program, (columns,), the constant 1 first."""
        columns, first = self.motion.columns, self.start.step
        point = np.zeros(columns.count)
        point[0] = 1.0
        used = slice(first, first + columns.requests)
        point[1 : 1 + columns.requests] = np.maximum(run.torque_request[used], 0.0)
        resisting = run.load_torque[first:]
        if run.holding_torque is not None:
            resisting = resisting + run.holding_torque[first:]
        engine, wheel = run.engine_speed[first:], run.wheel_speed[first:]
        if columns.load.stop > columns.load.start:
            point[columns.load] = self.load.rest(resisting, wheel)[:-1]
        if columns.engine.stop > columns.engine.start:
            point[columns.engine] = self.engine.rest(run.engine_torque[first:], engine)[:-1]
        if run.clutch_phase is not None:
            self._add_capacity(point, run)
        return point

    def _add_capacity(self, point: np.ndarray, run: Trajectory) -> None:
        """Write the remainder of the capacity of a run into its point."""
        columns, first = self.motion.columns, self.start.step
        rest = run.clutch_torque - self.settings.wear_gain * run.actuator_torque
        rest = rest[first : first + len(self.motion.capacity)]
        held = np.clip(rest[:, 0], self.capacity.low, self.capacity.high)
        if columns.capacity.stop > columns.capacity.start:
            point[columns.capacity] = held
        clipped = [k for k in sorted(self.capacity.clipped) if k < len(rest)]
        if clipped:
            point[columns.nodes] = (rest - held[:, np.newaxis])[clipped].ravel()


def case_at(
    settings: RunSettings, start: Start, lock_time_s: float, *, limited: bool = True
) -> Case:
    """
    Return the runs that lock `lock_time_s` after control start, near a rigid car.

    C_m is a variable where limits of the engine can act, unless `limited` is False: then these are
    the runs in which it is the demand throughout.
    """
    return Case(
        settings,
        start,
        Lock(lock_time_s),
        rigid_tube(settings, start, lock_time_s),
        limited,
        capacity_range(settings, start.temperature_c),
    )


def case_of_run(settings: RunSettings, start: Start, lock: Lock, run: Trajectory) -> Case | None:
    """
    Return the runs that lock when `run` does, which include it; None where none can.

    The engine of a run that always gave the demand stayed away from its limits: so it does in all
    these runs. Otherwise C_m is a variable. Where a run was clipped at zero capacity, these are.
    """
    first = start.step
    used = run.torque_request[:first]
    if not np.array_equal(np.maximum(used, 0.0), start.requests) or run.two_input:
        return None
    end = first + lock.periods + 1
    if not stays_within(run, first, end, start.temperature_c):
        return None
    limited = not gives_demand(run, first)
    capacity = capacity_range(settings, start.temperature_c)
    if settings.stick_slip:
        capacity = capacity.with_run(settings, run, range(first, end))
    return Case(
        settings,
        start,
        lock,
        rigid_tube(settings, start, lock.time_s).with_run(run, first),
        limited,
        capacity,
        max(MOST_REQUEST, float(run.torque_request[first:].max())),
    )


def gives_demand(run: Trajectory, start: int) -> bool:
    """Return whether the engine delivers the driver's demand from step `start` on."""
    return np.array_equal(run.engine_torque[start:-1], run.torque_demand[start:-1])
