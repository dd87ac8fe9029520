# Copyright 2026 DDCT team
# SPDX-License-Identifier: Apache-2.0
"""Runs that a floor covers, as rows of a program: they start alike and lock at one instant."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ddct_bringup.bag.trajectory import Trajectory
from ddct_bringup.floor.coverage import shorter_drive, why_outside
from ddct_bringup.floor.dynamics.capacity import CapacityRange, capacity_range
from ddct_bringup.floor.dynamics.engine_laws import EngineLaw, demand_law, engine_law
from ddct_bringup.floor.dynamics.laws import Law, load_law
from ddct_bringup.floor.dynamics.motion import Motion, motion_of
from ddct_bringup.floor.dynamics.stability import require_stable
from ddct_bringup.floor.dynamics.start import Start
from ddct_bringup.floor.dynamics.torque_cut import gives_demand
from ddct_bringup.floor.dynamics.tube import ENGINE_MARGIN, Tube, rigid_tube
from ddct_bringup.floor.lock import Lock
from ddct_bringup.floor.rows import Rows, band_rows, clutch_rows, engine_rows
from ddct_bringup.verdict.limits import packaged_limits
from ddct_bringup.verdict.rules import Rules
from ddct_plant.base.errors import ParameterError
from ddct_plant.base.timebase import time_of_step
from ddct_plant.scenario.settings import RunSettings

MOST_REQUESTS = 4.0
"""
Highest request that a floor covers, over that with which a worn clutch carries all that it can.

A compared run may request more.
"""


@dataclass(frozen=True, eq=False)
class Case:
    """
    Runs of one scenario from one state at control start that lock once, at one instant.

    What a controller changes is a variable in an interval: requests, and what the laws of engine,
    load and capacity leave over. Every run whose speeds stay in the band is a point.
    """

    settings: RunSettings
    start: Start
    lock: Lock
    tube: Tube
    limited: bool
    """Whether C_m may differ from the demand, as where limits of the engine act."""
    capacity: CapacityRange
    rules: Rules
    """Thresholds of the states; a linear clutch locks within their band."""
    most_request: float
    """Highest request in N m."""
    near_run: tuple[EngineLaw, Law] | None = None
    """Laws of C_m and of the load near one run, which the runs of a replay have; None: those of
    all runs."""

    @cached_property
    def engine(self) -> EngineLaw:
        """Law of C_m."""
        if self.near_run:
            return self.near_run[0]
        if self.limited:
            return engine_law(self.settings, self.tube, self.start.step, self.start.idle_integral)
        steps, locked = len(self.tube.engine_low), self.lock.periods
        return demand_law(self.settings, self.start.step, steps, locked)

    @cached_property
    def load(self) -> Law:
        """Law of the torque at the wheel."""
        if self.near_run:
            return self.near_run[1]
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
    def clutch_limits(self) -> Rows:
        """Rows of the slip and the capacity, the first of `inequalities`."""
        if self.settings.stick_slip:
            return clutch_rows(self.motion, self.capacity)
        return band_rows(self.motion, self.lock, self.rules.engaged_slip_rad_s)

    @cached_property
    def inequalities(self) -> Rows:
        """Rows of what is so in every run."""
        return self.clutch_limits + engine_rows(self.motion, self.engine)

    @cached_property
    def equations(self) -> np.ndarray:
        """Rows (p, columns) that are zero in every run: the slip at the instant of the lock."""
        slip = self.motion.slip_at_lock
        return np.zeros((0, self.motion.columns.count)) if slip is None else slip[np.newaxis]


def case_at(
    settings: RunSettings,
    start: Start,
    lock_time_s: float,
    rules: Rules | None = None,
    *,
    limited: bool = True,
) -> Case:
    """
    Return the runs that lock `lock_time_s` after control start, near a rigid car.

    C_m is a variable where limits of the engine can act, unless `limited` is False: then these are
    the runs in which it is the demand throughout. Without rules they are the packaged ones.
    Raise ParameterError where the engine reaches its cut.
    """
    tube = rigid_tube(settings, start, lock_time_s)
    case = Case(
        settings,
        start,
        Lock(lock_time_s),
        tube,
        limited,
        capacity_range(settings, start.temperature_c),
        rules or packaged_limits().rules,
        _most_request(settings),
    )
    _require_fuel(case)
    return case


def _require_fuel(case: Case) -> None:
    """
    Raise ParameterError where the engine of a rigid car reaches its cut.

    A fuel cut takes all torque and ends at another speed than it begins at: no linear program has
    such an engine, and a run that locks then may not be without the cut.
    """
    scenario, tube = case.settings.scenario, case.tube
    if scenario.engine_limits is None:
        return
    cut = scenario.engine_limits.cut_rad_s
    # The slower of the engine and of the locked car.
    reached = np.flatnonzero(tube.engine_low[:-1] + ENGINE_MARGIN >= cut)
    if reached.size:
        # The rigid car of an unstable model means nothing.
        require_stable(scenario.name, scenario.controlled_driveline, case.load, case.engine)
        step = case.start.step + int(reached[0])
        raise ParameterError(
            f'the engine reaches its cut, {cut:g} rad/s, at {time_of_step(step):.2f} s: there is '
            f'no floor; {shorter_drive(step)}',
            key='duration_s',
        )


def case_of_run(
    settings: RunSettings, start: Start, lock: Lock, run: Trajectory, rules: Rules | None = None
) -> Case | None:
    """
    Return the runs that lock when `run` does, which include it; None where none can.

    The engine of a run that always gave the demand stayed away from its limits: so it does in all
    these runs. Otherwise C_m is a variable. Where a run was clipped at zero capacity, these are.
    """
    first, rules = start.step, rules or packaged_limits().rules
    end = first + lock.periods + 1
    if why_outside(settings, start, run, rules):
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
        rules,
        max(_most_request(settings), float(run.torque_request[first:].max())),
    )


def _most_request(settings: RunSettings) -> float:
    """Return the highest request in N m that a floor of these settings covers."""
    return MOST_REQUESTS * settings.scenario.friction.worn_request
